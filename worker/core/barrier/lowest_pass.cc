#include "core/barrier/lowest_pass.h"

#include <algorithm>
#include <utility>

namespace affskel::core {

NeighbourGraph::NeighbourGraph(const Mesh& mesh) : first_(mesh.points.size() + 1, 0) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  pairs.reserve(6 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      pairs.emplace_back(a, b);
      pairs.emplace_back(b, a);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  neighbours_.reserve(pairs.size());
  for (const auto& [a, b] : pairs) {
    neighbours_.push_back(b);
    first_[a + 1] = static_cast<std::uint32_t>(neighbours_.size());
  }
  // Vertices without triangles have no neighbours.
  for (std::size_t v = 1; v < first_.size(); ++v) first_[v] = std::max(first_[v], first_[v - 1]);
}

std::uint32_t minimum_below(const NeighbourGraph& graph, std::span<const float> values, std::uint32_t from) {
  for (std::uint32_t at = from;;) {
    std::uint32_t least = at;
    for (const std::uint32_t next : graph.of(at)) {
      if (std::pair(values[next], next) < std::pair(values[least], least)) least = next;
    }
    if (least == at) return at;
    at = least;
  }
}

void LowestPass::reach(std::span<const float> values, std::uint32_t vertex) {
  if (seen_[vertex] == flood_) return;
  seen_[vertex] = flood_;
  shore_.push_back({values[vertex], vertex});
  std::push_heap(shore_.begin(), shore_.end(),
                 [](const Place& a, const Place& b) { return a.value > b.value; });
}

LowestPass::Place LowestPass::lowest_of_shore() {
  std::pop_heap(shore_.begin(), shore_.end(),
                [](const Place& a, const Place& b) { return a.value > b.value; });
  const Place lowest = shore_.back();
  shore_.pop_back();
  return lowest;
}

float LowestPass::between(std::span<const float> values, std::uint32_t from, std::uint32_t to) {
  if (++flood_ == 0) {
    std::fill(seen_.begin(), seen_.end(), 0);
    flood_ = 1;
  }
  shore_.clear();
  reach(values, from);
  for (float level = values[from];;) {
    const Place at = lowest_of_shore();
    level = std::max(level, at.value);
    if (at.vertex == to) return level;
    for (const std::uint32_t next : graph_.of(at.vertex)) reach(values, next);
  }
}

}  // namespace affskel::core
