#pragma once

#include <vector>

#include "base/published_threshold.h"
#include "core/erosion/directions.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// Threshold for |H|, without unit and whatever the spacing: on a lattice H is Zucker and Hummel's / 26.
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
