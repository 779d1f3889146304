#include "core/curve/sheet_edges.h"

#include <algorithm>

namespace affskel::core {

SheetEdges::SheetEdges(const SheetMesh& sheet) {
  for (const Triangle& t : sheet.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(ascending(t[k], t[(k + 1) % 3]));
  for (const auto& [a, b] : sheet.segments) edges.push_back(ascending(a, b));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  const auto number = [&](std::uint32_t a, std::uint32_t b) {
    return static_cast<std::uint32_t>(std::lower_bound(edges.begin(), edges.end(), ascending(a, b)) -
                                      edges.begin());
  };
  for (const Triangle& t : sheet.triangles)
    of.push_back({number(t[0], t[1]), number(t[1], t[2]), number(t[2], t[0])});
  triangles = holders(edges.size(), of);
  round = holders(sheet.vertices.size(), edges);
  about = holders(sheet.vertices.size(), sheet.triangles);
}

}  // namespace affskel::core
