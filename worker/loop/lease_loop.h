#pragma once

#include <chrono>
#include <cstdint>
#include <stop_token>
#include <string>

#include "base/exit_code.h"
#include "wire/channel.h"

namespace affskel::worker {

struct LeaseLoopOptions {
  std::string server;                 ///< unix:PATH or HOST:PORT
  unsigned threads = 1;               ///< computing threads
  unsigned derive_threads = 1;        ///< of a derivation
  std::uint64_t memory = 0;           ///< bytes that it may take; 0 = what is available when it starts
  std::chrono::seconds idle_exit{0};  ///< leave after this long without work; 0 = never
  /// Leave when work on another job than the first max_jobs is offered; 0 = never.
  std::uint64_t max_jobs = 0;
  /// Of processor time that making a job ready may take; 0 = no bound.
  std::chrono::seconds prepare_limit{3600};
  std::chrono::seconds derive_limit{0};  ///< 0 = none; see TaskLimit
  std::chrono::seconds patience{60};     ///< leave when the server does not answer for this long
  wire::AccessFiles access = {};         ///< what it shows to the server
};

/// Leases tasks and works on them until told to stop, idle for too long, or left by the server.  On a
/// stop the direction in hand is finished and reported and the lease given back.
/// Returns kDone; kUnreachable when the server stayed away; kNotAllowed when it does not let this worker in.
/// @throws std::invalid_argument when a file of options.access is not good.
base::ExitCode run_lease_loop(const LeaseLoopOptions& options, std::stop_token stop);

}  // namespace affskel::worker
