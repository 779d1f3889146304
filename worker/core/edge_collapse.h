#pragma once

#include <cstddef>

#include "core/mesh.h"

namespace affskel::core {

/// Removes edges of a closed manifold mesh until `triangles` triangles are left (each collapse removes
/// two): CGAL Surface_mesh_simplification with the memoryless, volume-preserving cost and placement of
/// Lindstrom & Turk (1998); collapses that would turn a triangle over are refused.  Topology is kept.
/// The result may have more triangles when no edge is left that may be collapsed, and may cross itself:
/// check both.  A function of its arguments alone.
Mesh collapse_edges(const Mesh& mesh, std::size_t triangles);

}  // namespace affskel::core
