#include "faults.h"

#include <algorithm>
#include <random>
#include <thread>

#include "tools/let_pass.h"

namespace affskel::chaos {

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all = {
      {"kill-server", "kill -9 of the server", kill_server},
      {"kill-worker", "kill -9 of a worker", kill_worker},
      {"kill-all", "kill -9 of the server and both workers at once", kill_all},
      {"kill-server-in-submits", "kill -9 of the server while six clients submit",
       kill_server_amid_submissions},
      {"kill-submitting-client", "kill -9 of the command line while it submits", kill_submitting_client},
      {"kill-fetching-client", "kill -9 of the command line while it fetches a field", kill_fetching_client},
      {"term-server", "SIGTERM: the server drains and ends with 0", term_server},
      {"term-server-twice", "a second SIGTERM while the server drains", term_server_twice},
      {"kill-draining-server", "kill -9 while the server drains", kill_draining_server},
      {"term-worker", "SIGTERM: a worker reports and ends with 0", term_worker},
      {"term-worker-twice", "a second SIGTERM while a worker ends", term_worker_twice},
      {"stop-server", "SIGSTOP of the server beyond the lease, then SIGCONT", stop_server},
      {"stop-worker", "SIGSTOP of a worker beyond the lease, then SIGCONT", stop_worker},
      {"stop-all", "SIGSTOP of all beyond the lease, then SIGCONT: a laptop that sleeps", stop_all},
      {"second-server", "another server is started on the same data directory", second_server},
      {"net-delay", "every piece of a worker's and a client's connections comes late", net_delay},
      {"net-throttle", "these connections carry 4 kB a second", net_throttle},
      {"net-reset", "these connections are reset (RST)", net_reset},
      {"net-cut", "these connections are reset in the middle of a message", net_cut},
      {"net-close", "these connections are closed cleanly", net_close},
      {"net-half-close", "one direction of these connections is closed", net_half_close},
      {"net-black-hole", "what is sent vanishes, beyond the lease; then the connections are reset",
       net_black_hole},
      {"net-partition", "what is sent waits, beyond the lease, then arrives", net_partition},
      {"net-refuse", "connections are reset, new ones are refused", net_refuse},
      {"garbage-connections", "connections that begin with garbage", garbage_connections},
      {"silent-connections", "connections that say nothing", silent_connections},
      {"idle-connections", "200 connections that begin as HTTP/2 and say no more", idle_connections},
      {"disk-full", "the server's disk is filled to the last byte", disk_full},
      {"write-enospc", "ENOSPC from the server's writes, whatever it gives back", no_space},
      {"write-eio", "EIO from the server's writes", write_error},
      {"fsync-eio", "EIO from the server's fsync and fdatasync", sync_error},
      {"read-eio", "EIO from the server's reads", read_error},
      {"read-only", "EROFS from what changes files: a disk remounted read-only", read_only},
      {"short-writes", "half of what the server writes is written", short_writes},
      {"memory-server", "the server's memory may not grow", memory_server, kServer},
      {"memory-worker", "a worker's memory may not grow", memory_worker, kAWorker},
      {"clock-forward", "the server's clock jumps an hour ahead, and back", clock_forward},
      {"clock-back", "the server's clock jumps an hour back, and ahead", clock_back},
      {"clock-workers", "the workers' clocks jump, one ahead, one back", clock_workers},
      {"duplicate-submissions", "the same submission from eight clients at once", duplicate_submissions},
      {"submit-storm", "eight clients submit three jobs each", submit_storm},
      {"cancel-resume-storm", "four clients cancel and resume the running job", cancel_resume_storm},
      {"delete-storm", "jobs are submitted, cancelled and deleted by six clients", delete_storm},
      {"fetch-storm", "eight clients fetch fields and skeletons of new thresholds", fetch_storm},
      {"stalled-fetches", "twelve clients fetch and do not read on", stalled_fetches},
      {"watch-storm", "sixty watches, half of them abandoned", watch_storm},
      {"slow-uploads", "twenty uploads of a byte a second, while others submit", slow_uploads},
      {"half-report", "a worker's report with poisoned points breaks off half-way", half_report},
      {"late-report", "a worker reports poisoned points after it lost its lease", late_report},
      {"revoke-worker", "a worker's token is revoked while it works; it gets another", revoke_worker,
       kAWorker},
      {"revoke-client", "a client's token is revoked while it watches, uploads and fetches; it gets another",
       revoke_client},
  };
  return all;
}

const std::vector<Fault>& sabotages() {
  static const std::vector<Fault> all = {
      {"sabotage-report", "a worker with a lease reports poisoned points", poisoned_report},
      {"sabotage-job", "a finished job is deleted, and the ledger not told", job_deleted_in_secret},
  };
  return all;
}

std::vector<const Fault*> schedule(const std::vector<const Fault*>& kinds, std::size_t number,
                                   std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<const Fault*> result;
  while (!kinds.empty() && result.size() < number) {
    std::vector<const Fault*> round = kinds;
    for (std::size_t i = round.size(); i > 1; --i) std::swap(round[i - 1], round[random() % i]);
    result.insert(result.end(), round.begin(), round.end());
  }
  result.resize(std::min(result.size(), number));
  return result;
}

void last_for(Milliseconds time) {
  tests::let_pass(time);
}

void outlast_lease() {
  last_for(kLease + Milliseconds(250));
}

void in_parallel(std::size_t number, const std::function<void(std::size_t)>& work) {
  std::vector<std::jthread> threads;
  for (std::size_t i = 0; i < number; ++i) threads.emplace_back([&work, i] { work(i); });
}

}  // namespace affskel::chaos
