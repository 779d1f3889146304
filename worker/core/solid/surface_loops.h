#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Loops along the edges of closed surfaces that generate their first homology, two for each of the genus: the edges
/// that neither a spanning tree of the vertices nor one of the triangles uses, each closed along the former (tree and
/// cotree, Eppstein 2003).  A function of its argument alone.
/// @param mesh closed and manifold, as a Solid has it.
/// @return per loop its vertices, the first not repeated.
std::vector<std::vector<std::uint32_t>> surface_loops(const Mesh& mesh);

}  // namespace affskel::core
