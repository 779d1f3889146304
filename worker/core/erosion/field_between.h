#pragma once

#include <span>
#include <vector>

#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// What a field says of a place between sample points.
struct PlaceValue {
  double erosion = 0;  ///< E, mesh units cubed, >= 0
  double area = 0;     ///< of the section, mesh units squared: the slope |grad E|
};

/// E and its slope at places of a solid: at a sample point its own, elsewhere the means of E's tangents and
/// of the areas at those corners of the cell that are sample points, with trilinear weights.  Errors of E are
/// of order 2 in the spacing where E is smooth and at shocks, of order 1 at jumps.
/// @param places real lattice indices.
/// @return one value per place; NaN where no corner of its cell is a sample point with an optimal direction.
std::vector<PlaceValue> field_between(const Lattice& lattice, const FrameField& field,
                                      std::span<const Vec3> places);

}  // namespace affskel::core
