#include "core/spatial/box_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"

namespace affskel::core {

bool WayQuery::meets(const Box& box) const {
  double begin = 0, end = last;
  for (std::size_t k = 0; k < 3; ++k) {
    const double to_low = box.low[k] - slack - from[k], to_high = box.high[k] + slack - from[k];
    if (way[k] == 0 && (to_low > 0 || to_high < 0)) return false;
    if (way[k] == 0) continue;
    const double a = to_low / way[k], b = to_high / way[k];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return !(begin > end);
}

BoxTree::BoxTree(std::vector<Box> boxes, unsigned threads) : boxes_(std::move(boxes)), items_(boxes_.size()) {
  std::iota(items_.begin(), items_.end(), 0u);
  const auto count = static_cast<std::uint32_t>(items_.size());
  if (count == 0) return;
  nodes_.resize(halving_nodes(count, kLeafItems));
  build(0, 0, count, threads);
}

void BoxTree::build(std::uint32_t index, std::uint32_t first, std::uint32_t count, unsigned threads) {
  Box box = boxes_[items_[first]];
  std::uint32_t max_index = items_[first];
  for (std::uint32_t i = first + 1; i < first + count; ++i) {
    box.include(boxes_[items_[i]]);
    max_index = std::max(max_index, items_[i]);
  }
  nodes_[index] = {box, first, count, 0, max_index};
  if (count <= kLeafItems) return;

  const auto centre = [&](std::uint32_t i) { return 0.5 * boxes_[i].low + 0.5 * boxes_[i].high; };
  halve_node(nodes_, index, items_, threads, centre, [this](auto... half) { build(half...); });
}

}  // namespace affskel::core
