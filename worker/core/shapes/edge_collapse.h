#pragma once

#include <cstddef>

#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

enum class SelfCrossings { kAllowed, kNoNewOnes };

/// Collapses edges of an oriented manifold mesh in the half space x >= 0 until exactly `triangles` triangles
/// are left: CGAL Surface_mesh_simplification with the memoryless, volume-preserving cost and placement of
/// Lindstrom & Turk (1998).  The mesh's border, if any, lies in the plane x = 0; it stays there, and no
/// other vertex or edge gets there, so that the result can be joined with its mirror image.  Topology is
/// kept; collapses that would turn a triangle over are refused.  A closed mesh keeps an even number of
/// triangles.
///
/// The result has more triangles when no edge is left that may be collapsed: check.  Where crossings are allowed it may
/// cross itself, too; else it does not where `mesh` does not, which takes a third more time and wants a mesh without
/// degenerate triangles.  A function of its arguments alone.
/// @throws CoreError kBadInput when the mesh is not manifold, kCancelled when the context asks to stop.
Mesh collapse_edges(const Mesh& mesh, std::size_t triangles, ExecutionContext* context = nullptr,
                    SelfCrossings crossings = SelfCrossings::kAllowed);

}  // namespace affskel::core
