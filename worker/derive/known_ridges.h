#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "core/curve/curve_skeleton.h"
#include "core/ridge/ridge_sheet.h"

namespace affskel::worker {

/// What derivations have found of one finished field, for those that follow: a skeleton is mostly looked at as a
/// surface and measured next, or asked for at another threshold.
struct KnownRidges {
  static constexpr std::size_t kMost = 6;  ///< sheets and curves before a derivation; one takes three at most

  std::string job, field;  ///< which one, see Lease.field
  std::optional<core::RidgeBasis> basis = {};
  std::map<double, core::RidgeSheet> sheets = {};     ///< by RidgeBounds::low
  std::map<double, core::CurveSkeleton> curves = {};  ///< by CurveOptions::least_reach

  /// Before a derivation: forgets what is of another field, and sheets and curves where there are many.
  void look_at(const std::string& of_job, const std::string& of_field) {
    if (job != of_job || field != of_field) *this = {.job = of_job, .field = of_field};
    if (sheets.size() + curves.size() <= kMost) return;
    sheets.clear();
    curves.clear();
  }
};

}  // namespace affskel::worker
