#include "core/ridge/drawn_rims.h"

#include <algorithm>
#include <cstddef>

#include "core/base/disjoint_sets.h"

namespace affskel::core {

std::vector<SheetVertex> drawn_rims(const std::vector<SheetVertex>& vertices,
                                    const std::vector<std::array<std::uint32_t, 4>>& rings,
                                    const Adjacency& rim_neighbours, double low) {
  std::vector<SheetVertex> drawn = vertices;
  std::vector<std::uint32_t> met(vertices.size(), 0);
  const auto draw = [&](std::uint32_t v, std::uint32_t to) {
    const SheetVertex &at = vertices[v], &strong = vertices[to];
    if (at.kind != SkeletonKind::kRidge || strong.kind != SkeletonKind::kRidge) return;
    if (rim_neighbours[v].empty() || at.strength >= low || strong.strength < low) return;
    const double t = (1 / at.strength - 1 / low) / (1 / at.strength - 1 / strong.strength);
    drawn[v] =
        between(met[v] == 0 ? at : drawn[v], between(at, strong, t), 1 / static_cast<double>(met[v] + 1));
    ++met[v];
  };
  for (const auto& ring : rings) {
    for (std::size_t k = 0; k < 4; ++k) {
      draw(ring[k], ring[(k + 1) % 4]);
      draw(ring[k], ring[(k + 3) % 4]);
    }
  }
  // Corners, with no strong neighbour but across a square.
  const std::vector<std::uint32_t> beside = met;
  for (const auto& ring : rings) {
    for (std::size_t k = 0; k < 4; ++k)
      if (beside[ring[k]] == 0) draw(ring[k], ring[(k + 2) % 4]);
  }
  for (std::size_t v = 0; v < met.size(); ++v)
    if (met[v] > 0) drawn[v].strength = low;
  return drawn;
}

std::vector<int> rim_passes(const Adjacency& rim_neighbours, int most) {
  const auto count = static_cast<std::uint32_t>(rim_neighbours.size());
  DisjointSets rims(count);
  for (std::uint32_t v = 0; v < count; ++v)
    for (const std::uint32_t to : rim_neighbours[v]) rims.unite(v, to);
  std::vector<std::uint64_t> length(count, 0);
  for (std::uint32_t v = 0; v < count; ++v) ++length[rims.find(v)];
  std::vector<int> passes;
  for (std::uint32_t v = 0; v < count; ++v) {
    const std::uint64_t n = length[rims.find(v)];
    passes.push_back(static_cast<int>(std::min<std::uint64_t>(n * n / 32, static_cast<std::uint64_t>(most))));
  }
  return passes;
}

}  // namespace affskel::core
