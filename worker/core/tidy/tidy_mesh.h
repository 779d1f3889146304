#pragma once

#include "core/mesh/mesh.h"

namespace affskel::core {

struct TidyOptions {
  double shortest_edge = 0;  ///< edges below this length are collapsed, mesh units, > 0
  int max_rounds = 32;       ///< of collapses and flips; a lattice's mesh is done after about ten
};

/// Removes the needles and caps of a closed manifold mesh that stems from a lattice, without moving a vertex:
/// edges that are too short are collapsed onto one of their ends, shortest first, and the long sides of flat
/// triangles flipped.  Vertices that no triangle uses any more are dropped, the others stay in order.
/// The mesh stays closed, manifold and of the same topology (link condition; no component goes below a
/// tetrahedron).  Changes that would turn a triangle over, or bend the surface sharply, are refused, so some
/// short edges and flat triangles may be left.
/// In rounds, each linear in the size of the mesh but for sorting; a function of its arguments alone.
Mesh tidy_mesh(const Mesh& mesh, const TidyOptions& options);

}  // namespace affskel::core
