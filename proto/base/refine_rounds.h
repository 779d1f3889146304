#pragma once

namespace affskel::base {

/// The most rounds of propagation that a refinement has after the first: where it is not at its end by then, little
/// is left to find.  Bodies take some ten.
inline constexpr int kMostRefineRounds = 64;

}  // namespace affskel::base
