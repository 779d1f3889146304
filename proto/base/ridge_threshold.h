#pragma once

namespace affskel::base {

/// Least strengths of the ridge's sheet that can be asked for, in radians per depth.  The core counts
/// strengths from 1e-6 to 1000; where the gradient of E vanishes they have no bound.
inline constexpr double kMinRidgeThreshold = 1e-6;
inline constexpr double kMaxRidgeThreshold = 800;

/// Least lengths of limbs that a curve skeleton can be asked for, in their own radii.
inline constexpr double kMinCurveThreshold = 0.9;
inline constexpr double kMaxCurveThreshold = 1000;

}  // namespace affskel::base
