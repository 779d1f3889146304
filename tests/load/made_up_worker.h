#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <stop_token>
#include <string>

#include "calls.h"

namespace affskel::load {

struct MadeUpWorkerOptions {
  std::string address;
  std::string id;
  std::uint32_t points = 2000;  ///< of every job that it prepares
  std::uint32_t directions = 64;
  std::chrono::milliseconds pause{1000};  ///< between two reports, as real workers have it
  std::uint32_t positions = 8;            ///< finished directions in a report
  std::uint32_t records = 2000;           ///< improved points in a report, at most all
  bool work_waits = false;                ///< at all times: calls have a "lease" for each
  /// Called after each report, with its bytes on the wire.
  std::function<void(std::size_t bytes)> acknowledged = [](std::size_t) {};
};

/// Leases tasks and reports made-up results until told to stop: the traffic of a worker without its sums, so
/// that the server alone is measured.
void run_made_up_worker(const MadeUpWorkerOptions& options, const std::stop_token& stop, Calls& calls);

}  // namespace affskel::load
