#include "core/spatial/box_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"

namespace affskel::core {
namespace {

constexpr std::uint32_t kLeaf = 4;

}  // namespace

BoxTree::BoxTree(std::vector<Box> boxes, unsigned threads) : boxes_(std::move(boxes)), items_(boxes_.size()) {
  std::iota(items_.begin(), items_.end(), 0u);
  const auto count = static_cast<std::uint32_t>(items_.size());
  if (count == 0) return;
  nodes_.resize(halving_nodes(count, kLeaf));
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
  if (count <= kLeaf) return;

  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (box.high[k] - box.low[k] > box.high[axis] - box.low[axis]) axis = k;
  }
  const auto centre = [&](std::uint32_t i) { return boxes_[i].low[axis] / 2 + boxes_[i].high[axis] / 2; };
  halve_node(nodes_, index, items_, kLeaf, threads, centre, [this](auto... half) { build(half...); });
}

}  // namespace affskel::core
