#pragma once

#include <string>
#include <vector>

#include "core/directions.h"
#include "core/lattice.h"
#include "core/shock_operator.h"

namespace affskel::core {

/// Why a thresholded skeleton is empty and what to try, one or more sentences for people: the largest |H|
/// there is and a threshold that would keep about as many points as a sheet through the lattice has; few
/// distinct optimal normals (a box has six: too few for shocks to show); too few sample points.
/// @param divergence H per sample point, none with |H| > threshold.
std::string empty_skeleton_advice(const Lattice& lattice, const OptimalDirections& optimal,
                                  const std::vector<double>& divergence, ShockOperator shock_operator,
                                  double threshold);

}  // namespace affskel::core
