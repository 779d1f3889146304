#pragma once

#include <cstddef>
#include <span>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Turns triangles so that those that share an edge with nobody else run round it in opposite senses: each patch, of
/// triangles that hang together across such edges, has one side in front, its first triangle's.  Where a patch has one
/// side only, some neighbours disagree.  Places and the order of triangles stay.
/// @param points how many vertices there are.
/// @param triangles each with three distinct corners, as of a sheet with rims and branches.
void agree_on_senses(std::size_t points, std::span<Triangle> triangles);

}  // namespace affskel::core
