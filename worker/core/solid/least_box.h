#pragma once

#include "core/base/matrix3.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Orthonormal axes of a box of least volume that holds all points of the mesh, in no particular order and of
/// either sign.  CGAL's oriented bounding box (Chang, Gorissen & Melchior 2011) searches by evolution, from
/// several fixed seeds; each find is rounded to 2^-26, which takes away what libm and instruction set did
/// to it, and goes on to the nearest local minimum (shrink_box); the least of these counts, within 1e-9 the
/// first.  A global minimum is likely, but not certain.
/// @param mesh of volume > 0.
Matrix3 least_box_axes(const Mesh& mesh);

}  // namespace affskel::core
