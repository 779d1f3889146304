#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Whether points lie in a plane, but for the rounding of single precision: in that through the first, the farthest from
/// it and the farthest from the line of these two.
/// @param points of the mesh.
bool lie_in_a_plane(const Mesh& mesh, const std::vector<std::uint32_t>& points);

/// Whether all triangles of a mesh lie in a plane, so that they enclose nothing however their holes are filled.
bool is_flat_sheet(const Mesh& mesh);

}  // namespace affskel::core
