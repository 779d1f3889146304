#include "core/spatial/box_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"

namespace affskel::core {
namespace {

double centre_of(const Box& box, std::size_t axis) {
  return box.low[axis] / 2 + box.high[axis] / 2;
}

}  // namespace

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

  const std::size_t axis = longest_axis(first, count);
  const auto centre = [&](std::uint32_t i) { return centre_of(boxes_[i], axis); };
  halve_node(nodes_, index, items_, threads, centre, [this](auto... half) { build(half...); });
}

// Of the centres, not of the box: the faces of boxes within boxes all have their centres in the middle of the
// longest sides.  Halved there, by nothing but their indices, each half would fill the whole box again.
std::size_t BoxTree::longest_axis(std::uint32_t first, std::uint32_t count) const {
  Box centres;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const Box& box = boxes_[items_[i]];
    centres.include(Vec3{centre_of(box, 0), centre_of(box, 1), centre_of(box, 2)});
  }
  return centres.longest_axis();
}

}  // namespace affskel::core
