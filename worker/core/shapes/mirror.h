#pragma once

#include "core/mesh/mesh.h"

namespace affskel::core {

/// The half of a closed manifold mesh at x >= 0, its cut edges on the plane x = 0 exactly and
/// left open.  Vertices within `snap` of the plane are moved onto it first, which avoids slivers.
Mesh positive_x_half(Mesh mesh, double snap);

/// The mesh and its mirror image in the plane x = 0, joined at the vertices that lie on the plane: the
/// inverse of positive_x_half for a mirror-symmetric mesh.
Mesh with_mirror_image(const Mesh& half);

}  // namespace affskel::core
