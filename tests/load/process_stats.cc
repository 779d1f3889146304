#include "process_stats.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace affskel::load {

ProcessStats stats_of(pid_t pid) {
  const std::string directory = "/proc/" + std::to_string(pid);
  ProcessStats stats;
  std::ifstream status(directory + "/status");
  std::string word;
  while (status >> word) {
    if (word == "VmHWM:") status >> stats.peak_kib;
    if (word == "VmRSS:") status >> stats.resident_kib;
    if (word == "Threads:") status >> stats.threads;
  }
  std::ifstream times(directory + "/stat");
  std::string line;
  std::getline(times, line);
  // The name in parentheses may hold blanks; user and system time are fields 14 and 15, it is the second.
  std::istringstream fields(line.substr(std::min(line.size(), line.rfind(')') + 1)));
  for (int field = 3; field < 14; ++field) fields >> word;
  double user = 0, system = 0;
  if (fields >> user >> system) stats.cpu_s = (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
  std::error_code gone;
  const std::filesystem::directory_iterator descriptors(directory + "/fd", gone);
  if (!gone) stats.descriptors = std::distance(begin(descriptors), end(descriptors));
  return stats;
}

}  // namespace affskel::load
