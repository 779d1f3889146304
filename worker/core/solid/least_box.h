#pragma once

#include "core/base/matrix3.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Orthonormal axes of a box of least volume that holds all points of the mesh, in no particular order and of
/// either sign.  A global minimum is likely, but not certain.  The same on all machines: see least_box.cc.
/// @param mesh of volume > 0.
Matrix3 least_box_axes(const Mesh& mesh);

}  // namespace affskel::core
