#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "result.h"

namespace affskel::bench {

/// One thing the project promises of its speed or memory, and what was measured.
struct Target {
  std::string what;
  double bound = 0;
  bool at_least = false;           ///< else at most
  std::optional<double> measured;  ///< the worst of the rows it speaks of; nothing when none was measured
  std::string row;                 ///< the row that gave it

  bool met() const { return measured && (at_least ? *measured >= bound : *measured <= bound); }
};

/// Growth exponents of a set of results, nothing when its rows were not measured.
struct Growth {
  std::optional<double> wall_over_n;   ///< of the wall time, bodies, fixed R and K
  std::optional<double> wall_over_r;   ///< of the wall time, fixed N and K
  std::optional<double> sweep_over_r;  ///< of the sweep alone
};

Growth growth_of(std::span<const RowResult> results);

/// All targets, those not measured included.
std::vector<Target> targets_of(std::span<const RowResult> results);

void to_json(nlohmann::json& json, const Target& target);
void to_json(nlohmann::json& json, const Growth& growth);

}  // namespace affskel::bench
