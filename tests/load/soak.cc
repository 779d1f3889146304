#include <cstdio>
#include <filesystem>
#include <sstream>
#include <vector>

#include "../integration/lab.h"
#include "calls.h"
#include "loads.h"
#include "process_stats.h"

namespace affskel::load {
namespace {

// Jobs that wait or run at once.
constexpr int kAhead = 32;

// Lines of the table.
constexpr int kLines = 20;

/// A box, of another size every time: a mesh of its own with the same work in it.
std::string box(int number) {
  const double height = 1 + 1e-6 * number;
  std::ostringstream off;
  off.precision(17);
  off << "OFF\n8 12 0\n";
  for (int v = 0; v < 8; ++v) off << (v & 1) << ' ' << (v >> 1 & 1) << ' ' << (v >> 2) * height << '\n';
  off << "3 0 2 1\n3 1 2 3\n3 4 5 6\n3 5 7 6\n3 0 1 4\n3 1 5 4\n3 2 6 3\n3 3 6 7\n3 0 4 2\n3 2 4 6\n3 1 3 5\n"
         "3 3 7 5\n";
  return off.str();
}

void print_line(int done, pid_t server, const std::vector<integration::Process>& workers,
                const std::string& log) {
  const ProcessStats held = stats_of(server);
  std::error_code none;
  std::printf("%7d %10.1f %8ld %12ld", done, static_cast<double>(held.resident_kib) / 1024,
              static_cast<long>(held.threads), static_cast<long>(held.descriptors));
  for (const integration::Process& worker : workers) {
    const ProcessStats one = stats_of(worker.pid());
    std::printf(" | %8.1f %8ld %12ld", static_cast<double>(one.resident_kib) / 1024,
                static_cast<long>(one.threads), static_cast<long>(one.descriptors));
  }
  std::printf(" | %8.1f\n", static_cast<double>(std::filesystem::file_size(log, none)) / 1024);
  std::fflush(stdout);
}

}  // namespace

bool run_soak(const LoadOptions& options) {
  const integration::Lab lab;
  const integration::Process server = lab.server();
  std::vector<integration::Process> workers;
  for (int i = 0; i < std::min(options.workers, 2); ++i) workers.push_back(lab.worker({"--threads", "1"}));
  const auto stub = v1::ErosionService::NewStub(connect(lab.address()));
  std::printf("soak: %d jobs\n%7s %10s %8s %12s", options.jobs, "jobs", "server MiB", "threads",
              "descriptors");
  for (std::size_t i = 0; i < workers.size(); ++i)
    std::printf(" | %8s %8s %12s", "MiB", "threads", "descriptors");
  std::printf(" | %8s\n", "log KiB");
  std::vector<std::string> ids;
  int failed = 0, done = 0;
  const int step = std::max(1, options.jobs / kLines);
  const auto settle = [&] {
    const v1::Job job = lab.follow_to_end(ids[static_cast<std::size_t>(done)]);
    if (job.state() != v1::JOB_STATE_DONE) ++failed;
    if (++done % step == 0) print_line(done, server.pid(), workers, lab.path("server.log"));
  };
  for (int i = 0; i < options.jobs; ++i) {
    v1::Job job;
    const grpc::Status status = submit(*stub, box(i), "box " + std::to_string(i), &job, 0.34);
    if (!status.ok()) {
      std::printf("submission %d failed: %s\n", i, status.error_message().c_str());
      return false;
    }
    ids.push_back(job.id());
    if (i >= kAhead) settle();
  }
  while (done < options.jobs) settle();
  std::printf("%d jobs failed\n\n", failed);
  return failed == 0;
}

}  // namespace affskel::load
