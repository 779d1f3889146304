#pragma once

#include <vector>

#include "base/published_threshold.h"
#include "core/erosion/directions.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// Threshold for |H|, without unit and whatever the spacing.  With s a step to a neighbour, the sum of
/// n(x + s) . s / |s| over the 26 of them is, regrouped by axes, Zucker and Hummel's sum of differences:
/// their weights 1, sqrt(2)/2, sqrt(3)/3 are the 1 / |s|.  On a lattice the average outward flux therefore is
/// their H / 26, and 7 / 26 keeps the same points, up to rounding.
constexpr double kAverageOutwardFluxThreshold = base::kZuckerHummelThreshold / 26;

/// H = div n of the optimal normals at every sample point as the average outward flux through the sphere of
/// the 26 neighbours (divergence theorem; Siddiqi, Bouix, Tannenbaum and Zucker 2002, section 4): the mean
/// of n(neighbour) . outward unit vector.  Negative at sinks of n, positive at sources.  A neighbour outside
/// the solid counts as the centre itself.
/// @param directions unit normals in the lattice's frame (see frame_directions).
/// Returns one value per point; |H| <= 1.
std::vector<double> average_outward_flux(const Lattice& lattice, const DirectionSet& directions,
                                         const OptimalDirections& optimal,
                                         ExecutionContext* context = nullptr);

}  // namespace affskel::core
