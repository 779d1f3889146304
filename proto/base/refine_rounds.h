#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace affskel::base {

/// The most rounds of propagation that a refinement has after the first: where it is not at its end by then, little
/// is left to find.  Bodies take some ten.
inline constexpr int kMostRefineRounds = 64;

/// How much of a refinement is done, in sample points, in a round with `done` of all `points` behind it: of eight points
/// one begins in round 0, three each in rounds 1 and 2, one in round 3; in round 4 all look wider, which takes half as long
/// as all that (core/infimum/refinement.h).  What later rounds do is little.
inline std::int64_t refine_points_begun(std::int64_t round, std::int64_t done, std::int64_t points) {
  constexpr std::array<std::int64_t, 7> kBefore = {0, 1, 4, 7, 8, 12, 12};
  const auto r = static_cast<std::size_t>(std::clamp<std::int64_t>(round, 0, 5));
  return (kBefore[r] * points + (kBefore[r + 1] - kBefore[r]) * done) / kBefore.back();
}

}  // namespace affskel::base
