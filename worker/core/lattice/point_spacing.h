#pragma once

#include <cstdint>

#include "core/lattice/lattice.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// Whether so many sample points are what was aimed at: within 10 %.
bool is_near(std::uint64_t points, std::uint64_t target);

/// A spacing whose lattice has about `options.target_points` sample points.  Most solids have them at
/// dT = (v0 / target)^(1/3), which make_lattice tries first and keeps when it is near.  Solids thinner than
/// that are not: a plate between two layers of points has none, one that a layer runs through has too many.
/// There the number of points jumps as dT changes and need not fall as dT grows.  From `first` dT is doubled
/// or halved until the target is bracketed, and the bracket halved in the logarithm until a lattice is near.
/// Where none is, and first of all for foils, spacings round (A / 2 target)^(1/2) are tried, A the area of
/// the surface: a layer through the middle of all that is thin.  At last (two layers have twice the points of
/// one) the nearest that was met.  A function of the solid and the options alone, the same on any number of
/// threads.
/// @param first a spacing, mesh units, > 0, finite; returned when no lattice met has any points.
double spacing_for_points(const Solid& solid, const LatticeOptions& options, double first);

/// Whether the spacing is many times the solid's mean thickness, 2 v0 / A: so fine a lattice for so few
/// points that its one layer, should it lie in the foil, has far too many.
bool is_foil(const Solid& solid, double spacing);

}  // namespace affskel::core
