#include <chrono>
#include <cstdio>
#include <random>
#include <string>

#include "../integration/lab.h"
#include "loads.h"
#include "tools/let_pass.h"

namespace affskel::load {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Kill {
  double unreported = 0;  // seconds of work that was not reported
  double back = 0;        // seconds from the new worker's start to its first report
};

/// Kills the worker `after` it was heard of, starts another, and waits for its first report.
Kill kill_once(const integration::Lab& lab, const std::string& id, integration::Process& worker,
               std::chrono::duration<double> after) {
  const std::uint64_t before = lab.job(id).counters().reports();
  lab.follow(id, [&](const v1::Job& job) { return job.counters().reports() > before; });
  const Clock::time_point heard = Clock::now();
  tests::let_pass(std::chrono::duration_cast<std::chrono::nanoseconds>(after));
  Kill kill;
  kill.unreported = seconds_since(heard);
  worker.kill_hard();
  const std::uint64_t accepted = lab.job(id).counters().reports();
  const Clock::time_point started = Clock::now();
  worker = lab.worker();
  lab.follow(id, [&](const v1::Job& job) { return job.counters().reports() > accepted; });
  kill.back = seconds_since(started);
  return kill;
}

}  // namespace

bool run_kills(const LoadOptions& options) {
  const integration::Lab lab;
  const integration::Process server = lab.server();
  integration::Process worker = lab.worker();
  lab.make_torus(2048);
  const std::string id = lab.submit({"--points", "100000", "--directions", "sphere:1000000"});
  std::mt19937_64 random(1);
  // Workers report about once a second: any moment up to the next one.
  std::uniform_real_distribution<double> moment(0, 1);
  Kill sum;
  std::printf("kills: the only worker, %d times\n", options.kills);
  for (int i = 0; i < options.kills; ++i) {
    const Kill kill = kill_once(lab, id, worker, std::chrono::duration<double>(moment(random)));
    std::printf("kill -9 %5.2f s after a report, the next one %5.2f s after the new start\n", kill.unreported,
                kill.back);
    sum.unreported += kill.unreported;
    sum.back += kill.back;
  }
  const v1::Job job = lab.job(id);
  const bool good = job.state() == v1::JOB_STATE_RUNNING && job.counters().directions_repeated() == 0;
  std::printf(
      "mean: %.2f s unreported, %.2f s to the next report; %llu reported directions computed again%s\n\n",
      sum.unreported / options.kills, sum.back / options.kills,
      static_cast<unsigned long long>(job.counters().directions_repeated()),
      job.state() == v1::JOB_STATE_RUNNING ? "" : "; not running any more");
  return good;
}

}  // namespace affskel::load
