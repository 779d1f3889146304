#pragma once

#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Removes the needles and caps of a closed manifold mesh that stems from a lattice, without moving a vertex:
/// edges that are too short are collapsed onto one of their ends, shortest first, and the long sides of flat
/// triangles flipped.  Vertices that no triangle uses any more are dropped, the others stay in order.
/// The mesh stays closed, manifold and of the same topology (link condition; no component goes below a
/// tetrahedron).  Changes that would turn a triangle over, or bend the surface sharply, are refused, so some
/// short edges and flat triangles may be left.
/// @param shortest_edge edges below this length are collapsed, mesh units, > 0.
/// In rounds, each linear in the size of the mesh but for sorting; a function of its arguments alone.
/// @throws CoreError kCancelled when the context, if there is one, asks to stop; it is asked in every round.
Mesh tidy_mesh(const Mesh& mesh, double shortest_edge, ExecutionContext* context = nullptr);

}  // namespace affskel::core
