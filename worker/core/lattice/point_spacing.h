#pragma once

#include <cstdint>

#include "core/lattice/lattice.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// Whether so many sample points are what was aimed at: within 10 %.
bool is_near(std::uint64_t points, std::uint64_t target);

/// A spacing whose lattice has `options.target_points` sample points, within 10 % (is_near) where there is
/// such a lattice, else as near as was found.  A function of the solid and the options alone, the same on any
/// number of threads.
/// @param first a spacing to begin with, mesh units, > 0, finite; returned when no lattice tried has any
///   points.
double spacing_for_points(const Solid& solid, const LatticeOptions& options, double first);

/// Whether the spacing is more than four times the solid's mean thickness, 2 v0 / A with A the area of the
/// surface: then a lattice has no points or, where a layer of it lies in the foil, far too many.
bool is_foil(const Solid& solid, double spacing);

}  // namespace affskel::core
