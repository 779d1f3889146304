// What workers cost the server: reports of small, medium and huge jobs by 1 to 64 made-up workers that do
// nothing else, real workers that have nothing to do, and from the times measured, by simulation, a thousand
// workers.
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <stop_token>
#include <thread>

#include "../integration/lab.h"
#include "closed_queue.h"
#include "loads.h"
#include "made_up_worker.h"
#include "process_stats.h"
#include "tools/exposition.h"
#include "tools/http_get.h"
#include "tools/let_pass.h"

namespace affskel::load {
namespace {

using Clock = std::chrono::steady_clock;

/// A job, and what a report of it brings.
struct JobSize {
  const char* name;
  std::uint32_t points, records;
};

// In the middle of a job: a real worker's first reports bring every point, its last ones a few.
constexpr JobSize kSizes[] = {{"small", 1000, 50}, {"medium", 100'000, 2000}, {"huge", 2'500'000, 100'000}};
constexpr int kSaturating = 8;  // workers whose reports keep the server busy all the time
constexpr std::uint32_t kDirections = 100'000;

std::uint64_t database_bytes(const integration::Lab& lab) {
  std::uint64_t sum = 0;
  for (const auto& file : std::filesystem::directory_iterator(lab.path("data"))) {
    std::error_code gone;
    const std::uintmax_t size = file.is_regular_file() ? file.file_size(gone) : 0;
    if (!gone) sum += size;
  }
  return sum;
}

double metric(const integration::Lab& lab, const std::string& name,
              const std::map<std::string, std::string>& labels = {}) {
  const std::string text = tests::http_get(lab.metrics_address(), "/metrics").body;
  return tests::value_of(tests::read_exposition(text), name, labels);
}

/// What the server has spent so far.
struct Spent {
  double cpu_s, transactions, database_mib;
};

Spent spent(const integration::Lab& lab, pid_t server) {
  return {stats_of(server).cpu_s, metric(lab, "affskel_transaction_duration_seconds_count"),
          static_cast<double>(database_bytes(lab)) / (1 << 20)};
}

/// The acknowledged reports of all workers, from begin() on.
class Reports {
 public:
  void add(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    bytes_ += bytes;
    times_.push_back(Clock::now());
  }
  void begin() {
    const std::lock_guard lock(mutex_);
    bytes_ = 0;
    times_.clear();
  }
  std::size_t count() const { return times_.size(); }
  std::size_t bytes() const { return bytes_; }
  /// Seconds from one report's end to the next one's: where the server is always busy, what it needs for one.
  std::vector<double> gaps() const {
    std::vector<double> gaps;
    for (std::size_t i = 1; i < times_.size(); ++i)
      gaps.push_back(std::chrono::duration<double>(times_[i] - times_[i - 1]).count());
    return gaps;
  }

 private:
  std::mutex mutex_;
  std::size_t bytes_ = 0;
  std::vector<Clock::time_point> times_;
};

/// Workers that do nothing but report, as fast as they are answered.  Prints a row of the table.
/// @returns the gaps between acknowledgements.
std::vector<double> run_reporters(const JobSize& size, int workers, const LoadOptions& options,
                                  Calls& calls) {
  const integration::Lab lab;
  const integration::Process server = lab.server({"--metrics", "127.0.0.1:0"});
  const auto client = v1::ErosionService::NewStub(connect(lab.address()));
  v1::Job job;
  calls.timed("submit", [&] { return submit(*client, size.name, size.name, &job); });
  Reports reports;
  std::stop_source stop;
  std::vector<MadeUpWorkerOptions> made_up(static_cast<std::size_t>(workers));
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < made_up.size(); ++i) {
    made_up[i] = {.address = lab.address(),
                  .id = "made-up-" + std::to_string(i),
                  .points = size.points,
                  .directions = kDirections,
                  .pause = std::chrono::milliseconds(0),
                  .positions = 1,
                  .records = size.records,
                  .acknowledged = [&](std::size_t bytes) { reports.add(bytes); }};
    threads.emplace_back([&, i] { run_made_up_worker(made_up[i], stop.get_token(), calls); });
  }
  lab.follow(job.id(), [](const v1::Job& now) { return now.directions_done() > 0; });
  reports.begin();
  const Spent before = spent(lab, server.pid());
  const Clock::time_point start = Clock::now();
  tests::let_pass(std::chrono::seconds(options.seconds));
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  const Spent after = spent(lab, server.pid());
  stop.request_stop();
  for (std::thread& thread : threads) thread.join();
  const auto count = static_cast<double>(reports.count());
  std::printf("| %s | %d | %.0f | %.2f | %.2f | %.1f | %.0f %% | %.0f |\n", size.name, workers,
              count / seconds, 1e3 * (after.cpu_s - before.cpu_s) / count,
              (after.transactions - before.transactions) / count,
              static_cast<double>(reports.bytes()) / 1024 / count,
              100 * (after.cpu_s - before.cpu_s) / seconds, after.database_mib - before.database_mib);
  std::fflush(stdout);
  return reports.gaps();
}

/// Real workers of a server without jobs.
void run_idle(const LoadOptions& options) {
  const integration::Lab lab;
  const integration::Process server = lab.server({"--metrics", "127.0.0.1:0"});
  std::vector<integration::Process> workers;
  for (int i = 0; i < options.workers; ++i) workers.push_back(lab.worker({"--threads", "1"}));
  while (metric(lab, "affskel_workers", {{"state", "idle"}}) < options.workers)
    tests::let_pass(std::chrono::milliseconds(100));
  const auto cpu_of_workers = [&] {
    double sum = 0;
    for (const integration::Process& worker : workers) sum += stats_of(worker.pid()).cpu_s;
    return sum;
  };
  const double server_before = stats_of(server.pid()).cpu_s, workers_before = cpu_of_workers();
  tests::let_pass(std::chrono::seconds(options.seconds));
  std::printf("%d idle workers: server %.2f %% of a core, all workers together %.2f %%\n\n", options.workers,
              100 * (stats_of(server.pid()).cpu_s - server_before) / options.seconds,
              100 * (cpu_of_workers() - workers_before) / options.seconds);
}

void print_simulated(const JobSize& size, const std::vector<double>& service) {
  if (service.empty()) return;
  for (const int workers : {10, 100, 300, 1000}) {
    const ClosedQueueResult result = simulate_closed_queue(service, {.callers = workers});
    std::printf("| %s | %d | %.0f | %.0f %% | %.1f | %.1f |\n", size.name, workers, result.calls_per_second,
                100 * result.utilisation, 1e3 * result.response_median, 1e3 * result.response_p99);
  }
}

}  // namespace

bool run_scale(const LoadOptions& options) {
  run_idle(options);
  Calls calls;
  std::printf(
      "| job | workers | reports/s | server ms of processor/report | transactions/report | KiB/report | "
      "server of a "
      "core | database grew, MiB |\n|---|--:|--:|--:|--:|--:|--:|--:|\n");
  std::vector<std::vector<double>> service;  // of each size
  for (const JobSize& size : kSizes) {
    for (const int workers : {1, 2, 4}) run_reporters(size, workers, options, calls);
    service.push_back(run_reporters(size, kSaturating, options, calls));
  }
  run_reporters(kSizes[0], options.workers, options, calls);
  std::printf("\nSimulated: workers that report once a second, at the times measured with %d\n", kSaturating);
  std::printf(
      "| job | workers | reports/s | server busy | answer ms, median | p99 |\n|---|--:|--:|--:|--:|--:|\n");
  for (std::size_t s = 0; s < std::size(kSizes); ++s) print_simulated(kSizes[s], service[s]);
  std::printf("\n");
  calls.print();
  std::printf("\n");
  return calls.failures() == 0;
}

}  // namespace affskel::load
