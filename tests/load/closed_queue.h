#pragma once

#include <cstdint>
#include <vector>

namespace affskel::load {

struct ClosedQueueOptions {
  int callers = 1;        ///< each thinks, calls, waits for its answer, and thinks again
  double think = 1;       ///< seconds between an answer and the caller's next call
  double duration = 300;  ///< seconds that are simulated
  double warm_up = 30;    ///< of these, not counted
  std::uint64_t seed = 1;
};

struct ClosedQueueResult {
  double calls_per_second = 0;
  double utilisation = 0;      ///< share of the time in which the server serves
  double response_median = 0;  ///< seconds from a call to its answer
  double response_p99 = 0;
};

/// Simulates one server that answers one call after the other, in the order in which they come, for a fixed
/// number of callers (the machine repair model; D. Gross et al., Fundamentals of Queueing Theory, 2.8).
/// @param service measured times, seconds, not empty; each call takes one of them at random.
ClosedQueueResult simulate_closed_queue(const std::vector<double>& service,
                                        const ClosedQueueOptions& options);

}  // namespace affskel::load
