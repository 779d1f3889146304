#pragma once

#include "core/base/execution_context.h"
#include "core/base/matrix3.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Orthonormal axes of a box of least volume that holds all points of the mesh, in no particular order and of
/// either sign.  A global minimum is likely, but not certain.  The same on all machines: see least_box.cc.
/// @param mesh of volume > 0.
/// @throws CoreError kCancelled when the context asks to stop, which CGAL's searches do not ask.
Matrix3 least_box_axes(const Mesh& mesh, ExecutionContext* context = nullptr);

}  // namespace affskel::core
