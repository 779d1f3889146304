#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/mesh.h"

namespace affskel::core {

struct SelfIntersectionOptions {
  std::size_t max_pairs = 10;  ///< stop after this many
};

/// Pairs of triangles that share a point not due to shared vertices and edges, sorted; at most
/// `options.max_pairs`.  Exact decisions (CGAL Polygon_mesh_processing::self_intersections on the
/// triangle soup, exact predicates).  Coordinates must be finite.
std::vector<std::pair<std::uint32_t, std::uint32_t>> self_intersections(
    const Mesh& mesh, const SelfIntersectionOptions& options = {});

}  // namespace affskel::core
