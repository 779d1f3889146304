#pragma once

#include "core/base/affine_map.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// The mesh with its points mapped; for a reflection the triangles are turned over, so that they still point
/// outward.
/// @throws CoreError kBadInput when the map is singular or a mapped coordinate is not finite.
Mesh map_mesh(const AffineMap& map, const Mesh& mesh);

}  // namespace affskel::core
