#pragma once

#include <cstdint>

#include "core/mesh/mesh.h"
#include "core/solid/betti_numbers.h"

namespace affskel::core {

/// The topology of a triangulated sheet that may have rims, branches and closed parts.
struct SheetTopology {
  BettiNumbers betti;
  std::uint64_t boundary_loops = 0;  ///< connected components of the rim: the edges with one triangle
  std::uint64_t branch_edges = 0;    ///< edges where more than two triangles meet
};

/// Counts cells: V - E + F = b0 - b1 + b2, b0 by union-find over the vertices that triangles use, and b2 as
/// the dimension of the closed surfaces modulo 2 in the complex (in space: the voids that it encloses).
/// Triangles joined through edges of exactly two are taken as one patch, so that b2 is the number of patches
/// less the rank of the conditions that rims and branches put on them.
/// O(F log F), and on top an elimination in the number of patches at branches.
/// @param sheet triangles distinct, each with three distinct corners; orientation does not matter.
SheetTopology sheet_topology(const Mesh& sheet);

}  // namespace affskel::core
