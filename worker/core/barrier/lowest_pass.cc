#include "core/barrier/lowest_pass.h"

#include <algorithm>
#include <functional>

namespace affskel::core {

std::uint32_t minimum_below(const Adjacency& graph, std::span<const float> values, std::uint32_t from) {
  for (std::uint32_t at = from;;) {
    std::uint32_t least = at;
    for (const std::uint32_t next : graph[at]) {
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
  std::push_heap(shore_.begin(), shore_.end(), std::greater<>());
}

float LowestPass::between(std::span<const float> values, std::uint32_t from, std::uint32_t to) {
  if (++flood_ == 0) {
    std::fill(seen_.begin(), seen_.end(), 0);
    flood_ = 1;
  }
  shore_.clear();
  reach(values, from);
  for (float level = values[from];;) {
    std::pop_heap(shore_.begin(), shore_.end(), std::greater<>());
    const auto [value, vertex] = shore_.back();
    shore_.pop_back();
    level = std::max(level, value);
    if (vertex == to) return level;
    for (const std::uint32_t next : graph_[vertex]) reach(values, next);
  }
}

}  // namespace affskel::core
