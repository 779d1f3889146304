#include "core/infimum/four_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/spatial/halved_nodes.h"

namespace affskel::core {
namespace {

// Boxes of points and of edges along an axis would have sides of a denormal number: a processor takes a hundred
// times as long for a product with one.
constexpr float kLeastSide = 1e-20F;

}  // namespace

class FourTree::Builder {
 public:
  Builder(const std::vector<Box>& boxes, std::vector<std::vector<Node>>& levels)
      : boxes_(boxes), levels_(levels), order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    std::size_t depth = 1;
    for (std::size_t held = 4; held < order_.size(); held *= 4) ++depth;
    levels_.assign(depth, {});
    build(0, {0, static_cast<std::uint32_t>(order_.size())});
  }

  std::vector<std::uint32_t> take_order() { return std::move(order_); }

 private:
  struct Range {
    std::uint32_t first = 0, count = 0;
  };

  // Of whole leaves; a leaf has no second half.
  std::array<Range, 2> halves(const Range& range) {
    const std::uint32_t half = std::min(range.count, (range.count / 2 + 3) / 4 * 4);
    if (half == range.count) return {range, Range{}};
    halve_items(std::span(order_).subspan(range.first, range.count), half,
                [&](std::uint32_t item) { return boxes_[item].low + boxes_[item].high; });
    return {Range{range.first, half}, Range{range.first + half, range.count - half}};
  }

  void put(Node& node, std::uint32_t place, const Box& box) const {
    const Vec3 middle = box.middle(), half = 0.5 * box.sides();
    for (std::size_t k = 0; k < 3; ++k) {
      node.boxes.centre[k][place] = static_cast<float>(middle[k]);
      node.boxes.half[k][place] =
          kLeastSide + std::nextafter(static_cast<float>(half[k]), std::numeric_limits<float>::infinity());
    }
  }

  std::uint32_t build(std::size_t level, const Range& range) {
    Node node{};
    constexpr float kNowhere = -std::numeric_limits<float>::infinity();  // as half a side
    for (Four& half : node.boxes.half) half = Four{kNowhere, kNowhere, kNowhere, kNowhere};
    if (level + 1 == levels_.size()) {
      for (std::uint32_t i = 0; i < range.count; ++i) {
        put(node, i, boxes_[order_[range.first + i]]);
        node.child[i] = order_[range.first + i];
      }
    } else {
      std::uint32_t size = 0;
      const auto [left, right] = halves(range);
      for (const Range& half : {left, right}) {
        for (const Range& quarter : halves(half)) {
          if (quarter.count == 0) continue;
          Box box;
          for (std::uint32_t i = 0; i < quarter.count; ++i) {
            const Box& item = boxes_[order_[quarter.first + i]];
            box.include(item.low);
            box.include(item.high);
          }
          put(node, size, box);
          node.child[size++] = build(level + 1, quarter);
        }
      }
    }
    levels_[level].push_back(node);
    return static_cast<std::uint32_t>(levels_[level].size() - 1);
  }

  const std::vector<Box>& boxes_;
  std::vector<std::vector<Node>>& levels_;
  std::vector<std::uint32_t> order_;
};

std::vector<std::uint32_t> FourTree::build(const std::vector<Box>& boxes) {
  return Builder(boxes, levels_).take_order();
}

}  // namespace affskel::core
