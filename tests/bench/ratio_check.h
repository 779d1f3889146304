#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "result.h"

namespace affskel::bench {

/// A ratio to a yardstick that is worse than expected by more than the factor.
struct RatioFailure {
  std::string row;
  std::string message;  ///< row, ratio, measured, expected
};

/// Compares the ratios of results with stored ones, {"factor": F, "rows": {NAME: {"trees_per_sort": T,
/// "plain_per_pruned": P}}}: a failure is a trees_per_sort above F T, a plain_per_pruned below P / F, and a
/// row that is expected but not measured or measured but not expected.
/// @throws std::runtime_error when `expected` has not that form.
std::vector<RatioFailure> check_ratios(const nlohmann::json& expected, std::span<const RowResult> results);

/// The expectations that these results would meet exactly, in the form above.
nlohmann::json ratios_of(std::span<const RowResult> results, double factor);

}  // namespace affskel::bench
