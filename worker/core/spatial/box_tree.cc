#include "core/spatial/box_tree.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

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

BoxTree::BoxTree(std::vector<Box> boxes, unsigned threads) : boxes_(std::move(boxes)) {
  std::vector<std::uint32_t> items(boxes_.size());
  std::iota(items.begin(), items.end(), 0U);
  const auto box_of = [this](std::span<const std::uint32_t> some) {
    Box box = boxes_[some[0]];
    for (const std::uint32_t i : some.subspan(1)) box.include(boxes_[i]);
    return box;
  };
  const auto centre = [this](std::uint32_t i) { return 0.5 * boxes_[i].low + 0.5 * boxes_[i].high; };
  tree_ = HalvedTree<Box>(std::move(items), threads, box_of, centre);
}

}  // namespace affskel::core
