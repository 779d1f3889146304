#pragma once

#include <span>
#include <vector>

#include "core/ridge/ridge_constants.h"
#include "core/ridge/ridge_curves.h"
#include "core/ridge/ridge_rims.h"

namespace affskel::core {

/// The stretches of ridge curves along which the solid is round, by two bounds on the strength and two on
/// lambda_2 / lambda_1 (hysteresis).  The ratio is that of E's second derivatives across the curve: 1 where E
/// falls alike on all sides.  It is averaged along the curve over one radius to both sides, so that noise
/// does not make many stretches of one.
/// @return in the order of the curves, along each of them; closed where a whole closed curve is round.
std::vector<RidgeCurve> round_stretches(std::span<const RidgeCurve> curves, const RidgeBounds& bounds = {},
                                        const RidgeConstants& constants = {});

/// The parts of a curve whose vertices are wanted, at least two to a part; closed if all are and the curve
/// is.
/// @param wanted per vertex.
std::vector<RidgeCurve> parts_of_curve(const RidgeCurve& curve, const std::vector<char>& wanted);

}  // namespace affskel::core
