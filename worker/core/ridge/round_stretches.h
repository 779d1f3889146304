#pragma once

#include <span>
#include <vector>

#include "core/ridge/ridge_curves.h"

namespace affskel::core {

struct RoundStretchOptions {
  double low_strength = 6;     ///< s_2 of a stretch is at least this, radians
  double high_strength = 6.5;  ///< ... and somewhere this, where max_roundness holds
  double max_roundness = 0.8;
  /// lambda_2 / lambda_1 of a stretch, smoothed, is at least the lower bound, and somewhere the higher one,
  /// 0 .. 1.  In elliptic cylinders whose axes are as 1 to 0.9, 0.8, 0.7, 0.6 and 0.5 it is 0.84, 0.69, 0.55,
  /// 0.43 and 0.31.
  double low_ratio = 0.4;
  double high_ratio = 0.5;
  double smoothing = 1;  ///< of the ratio: this far to both sides, radii, >= 0
};

/// The stretches of ridge curves along which the solid is round, by two bounds on the strength and two on
/// lambda_2 / lambda_1 (hysteresis).  The ratio is that of E's second derivatives across the curve: 1 where E
/// falls alike on all sides.  It is averaged along the curve over one radius to both sides, so that noise
/// does not make many stretches of one.
/// @return in the order of the curves, along each of them; closed where a whole closed curve is round.
/// @throws CoreError kBadInput when an option is out of range.
std::vector<RidgeCurve> round_stretches(std::span<const RidgeCurve> curves,
                                        const RoundStretchOptions& options = {});

/// The parts of a curve whose vertices are wanted, at least two to a part; closed if all are and the curve
/// is.
/// @param wanted per vertex.
std::vector<RidgeCurve> parts_of_curve(const RidgeCurve& curve, const std::vector<char>& wanted);

}  // namespace affskel::core
