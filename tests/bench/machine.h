#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace affskel::bench {

/// What the figures were measured on and with; no host name.
struct Machine {
  std::string processor;  ///< model, as the kernel names it
  unsigned processors = 0;
  std::string memory;  ///< "23.5 GB"
  std::string compiler;
  std::string build;  ///< "Release"
  std::string core_version;
  std::string date;           ///< UTC, year-month-day
  double load_at_start = 0;   ///< average of runnable processes over the last minute
  double load_at_finish = 0;  ///< the same; above 1 + threads it was not quiet
};

/// This machine, now.  load_at_finish is left 0.
Machine this_machine();

/// Average of runnable processes over the last minute.
double load_average();

void to_json(nlohmann::json& json, const Machine& machine);

}  // namespace affskel::bench
