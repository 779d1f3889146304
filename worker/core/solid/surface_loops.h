#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Loops along the edges of closed surfaces that generate their homology, two for each handle (tree and cotree:
/// Eppstein 2003).  Linear but for the loops' lengths.
/// @param mesh closed, oriented; edges have two triangles each.
/// @return the vertices of each, once round.
std::vector<std::vector<std::uint32_t>> surface_loops(const Mesh& mesh);

/// Whether two closed polylines that do not meet are linked an odd number of times: how often one passes over the
/// other in a picture of both.  Time: the product of their lengths.
///
/// A loop within a solid bounds a surface within it (modulo 2) exactly when it is linked so with no loop of the
/// solid's own surface (Alexander duality: the loops of the surface generate those of the outside).
/// @param a, b corners, of size 1 or so.
bool is_linked(std::span<const Vec3> a, std::span<const Vec3> b);

}  // namespace affskel::core
