#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/groups.h"
#include "core/contour/sheet_mesh.h"

namespace affskel::core {

/// What meets what in a sheet with its curves.
struct SheetEdges {
  std::vector<Segment> edges;                    ///< smaller vertex first, ascending
  std::vector<std::array<std::uint32_t, 3>> of;  ///< per triangle: from its k-th corner to the next
  Groups<std::uint32_t> triangles;               ///< per edge
  Groups<std::uint32_t> round;                   ///< per vertex: the edges that end there
  Groups<std::uint32_t> about;                   ///< per vertex: the triangles there

  /// @param sheet whose triangles have three corners each.
  explicit SheetEdges(const SheetMesh& sheet);

  std::uint32_t other_end(std::uint32_t edge, std::uint32_t v) const {
    return edges[edge][0] == v ? edges[edge][1] : edges[edge][0];
  }
};

/// Steps in a sheet from a corner of a triangle: to its others, and right across to that of the triangle beyond, where no third
/// meets them.
/// @param left per triangle: whether it is there. @param visit (to, triangle of that).
template <class Visit>
void for_each_step(const SheetMesh& sheet, const SheetEdges& edges, std::span<const char> left,
                   std::uint32_t t, std::uint32_t v, const Visit& visit) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (sheet.triangles[t][k] != v) visit(sheet.triangles[t][k], t);
    const Segment& far = edges.edges[edges.of[t][k]];
    if (far[0] == v || far[1] == v) continue;
    std::uint32_t beyond = t, count = 0;
    for (const std::uint32_t other : edges.triangles[edges.of[t][k]]) {
      if (!left[other]) continue;
      ++count;
      if (other != t) beyond = other;
    }
    if (count != 2) continue;
    for (const std::uint32_t to : sheet.triangles[beyond])
      if (to != far[0] && to != far[1]) visit(to, beyond);
  }
}

}  // namespace affskel::core
