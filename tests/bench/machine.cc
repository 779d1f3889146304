#include "machine.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/base/version.h"

namespace affskel::bench {
namespace {

std::string processor_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

std::string memory_size() {
  const double bytes =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GB", bytes / (1 << 30));
  return text;
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d", &utc);
  return text;
}

}  // namespace

double load_average() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? load : 0;
}

Machine this_machine() {
  Machine machine;
  machine.processor = processor_model();
  machine.processors = std::thread::hardware_concurrency();
  machine.memory = memory_size();
#if defined(__clang__)
  machine.compiler = __VERSION__;
#else
  machine.compiler = std::string("GCC ") + __VERSION__;
#endif
  machine.build = AFFSKEL_BENCH_BUILD;
  machine.core_version = core::kCoreVersion;
  machine.date = today();
  machine.load_at_start = load_average();
  return machine;
}

void to_json(nlohmann::json& json, const Machine& m) {
  json = {{"processor", m.processor},
          {"processors", m.processors},
          {"memory", m.memory},
          {"compiler", m.compiler},
          {"build", m.build},
          {"core_version", m.core_version},
          {"date", m.date},
          {"load_at_start", m.load_at_start},
          {"load_at_finish", m.load_at_finish}};
}

}  // namespace affskel::bench
