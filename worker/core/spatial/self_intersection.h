#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

struct SelfIntersectionOptions {
  std::size_t max_pairs = 10;           ///< stop after this many
  unsigned threads = 1;                 ///< >= 1; the pairs do not depend on it
  ExecutionContext* context = nullptr;  ///< asked whether to stop
};

/// The first `options.max_pairs` pairs (i, j), in lexicographic order, of triangles that share a point which
/// their common vertices and edges do not account for; i < j.  Two triangles folded flat onto each other, or
/// the same triangle twice, count.  Vertices are common when their indices are equal, not when their places
/// are: weld first.  A degenerate triangle (corners equal or on one line) takes no part: in a closed mesh its
/// neighbours have its edges, so nothing that crosses there is missed.
///
/// Any mesh will do: open, not manifold, with unused vertices.  Decisions are exact (CGAL's exact
/// predicates; the rules are those of Polygon_mesh_processing::self_intersections).  Time grows with the
/// pairs of overlapping bounding boxes; slivers and large fans have boxes of their own (see CloseTriangles).
/// @throws CoreError kBadInput when a used coordinate is not finite or an index is out of range; kCancelled
///   when the context asks to stop.
std::vector<std::pair<std::uint32_t, std::uint32_t>> self_intersections(
    const Mesh& mesh, const SelfIntersectionOptions& options = {});

/// Whether two triangles, neither degenerate, share a point which their common vertices and edges do not account for.  As
/// above: exact, vertices by their indices.
bool meet_beyond_common(const std::vector<Vec3>& points, const Triangle& s, const Triangle& t);

/// Whether the corners lie on one line, or are no three.  Exact.
bool is_degenerate(const std::vector<Vec3>& points, const Triangle& t);

/// Whether an edge of one of the triangles passes through the interior of the other.  Touching does not
/// count, for the smallest move could end it.  Exact.
bool pass_through(const Mesh& mesh, std::uint32_t i, std::uint32_t j);

/// Whether two triangles have a point in common.  Exact.  A degenerate one has none with any: its neighbours
/// have its edges.
bool triangles_meet(const Mesh& mesh, std::uint32_t i, std::uint32_t j);

}  // namespace affskel::core
