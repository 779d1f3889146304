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

  explicit SheetEdges(const SheetMesh& sheet);

  std::uint32_t other_end(std::uint32_t edge, std::uint32_t v) const {
    return edges[edge][0] == v ? edges[edge][1] : edges[edge][0];
  }
};

/// Steps in a sheet: from a vertex to the others of the triangles about it, and to those right across their far edges, where
/// two triangles meet.
/// @param left per triangle: whether it is there. @param visit (to, triangle of that).
template <class Visit>
void for_each_step(const SheetMesh& sheet, const SheetEdges& edges, std::span<const char> left,
                   std::uint32_t v, const Visit& visit) {
  const auto across = [&](std::uint32_t t, std::uint32_t e) {
    std::uint32_t beyond = t;
    int count = 0;
    for (const std::uint32_t other : edges.triangles[e]) {
      count += left[other] != 0;
      if (left[other] && other != t) beyond = other;
    }
    if (count != 2) return;
    for (const std::uint32_t to : sheet.triangles[beyond])
      if (to != edges.edges[e][0] && to != edges.edges[e][1]) visit(to, beyond);
  };
  for (const std::uint32_t e : edges.round[v]) {
    for (const std::uint32_t t : edges.triangles[e]) {
      if (!left[t]) continue;
      for (const std::uint32_t to : sheet.triangles[t])
        if (to != v) visit(to, t);
      for (const std::uint32_t far : edges.of[t])
        if (edges.edges[far][0] != v && edges.edges[far][1] != v) across(t, far);
    }
  }
}

}  // namespace affskel::core
