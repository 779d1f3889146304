#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/box.h"

namespace affskel::core {

/// Four numbers that are worked on at once (a vector type of GCC and Clang).
using Four = float __attribute__((vector_size(16)));

/// Boxes of four items side by side: centres and half sides, by coordinate.  In single precision; sides are
/// rounded up.
struct FourBoxes {
  std::array<Four, 3> centre, half;
};

/// Tells of boxes on which sides of a plane they may lie.  Errs within kSlack (scaled units), to the safe side.
class PlaneHeights {
 public:
  static constexpr float kSlack = 2e-6F;  // of coordinates of at most 1, with some twelve roundings

  /// The plane of normal d through x; |d| at most 2.
  PlaneHeights(const Vec3& x, const Vec3& d)
      : d_{static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)},
        offset_(static_cast<float>(dot(d, x))) {
    for (std::size_t k = 0; k < 3; ++k) size_[k] = d_[k] < 0 ? -d_[k] : d_[k];
  }

  Four middle(const FourBoxes& boxes) const {
    return boxes.centre[0] * d_[0] + boxes.centre[1] * d_[1] + boxes.centre[2] * d_[2] - offset_;
  }
  /// How far the box reaches from its middle at most.
  Four reach(const FourBoxes& boxes) const {
    return boxes.half[0] * size_[0] + boxes.half[1] * size_[1] + boxes.half[2] * size_[2] + kSlack;
  }

  /// No less than the distance of any point of a box from x, for all boxes.
  static Four distance(const FourBoxes& boxes, const Vec3& x) {
    Four sum = boxes.half[0] + boxes.half[1] + boxes.half[2] + kSlack;
    for (std::size_t k = 0; k < 3; ++k) {
      const Four away = boxes.centre[k] - static_cast<float>(x[static_cast<int>(k)]);
      sum += away < 0 ? -away : away;
    }
    return sum;
  }

 private:
  std::array<float, 3> d_, size_;
  float offset_;
};

/// A tree of boxes, four to a node, for queries by planes.  Immutable once it is built.
class FourTree {
 public:
  /// @return the items in the tree's order, in which visit() numbers them.
  std::vector<std::uint32_t> build(const std::vector<Box>& boxes);

  /// Lists the items, in ascending order, whose box meets(boxes) tells of with -1, not 0, of four that it is
  /// asked for at once.  Without branches on what is met: no processor foresees them.
  template <class Meets>
  void select(Meets meets, std::vector<std::uint32_t>& items) const {
    std::array<std::uint32_t, 4 * 32> open;  // no tree is deeper: a node has a quarter of its parent's items
    std::size_t count = 0, found = 0;
    open[count++] = 0;
    while (count > 0) {
      const Node& node = nodes_[open[--count]];
      const auto met = meets(node.boxes);
      if (node.leaf) {
        if (items.size() < found + 4) items.resize(2 * found + 64);
        for (std::uint32_t i = 0; i < 4; ++i) {
          items[found] = node.child[i];
          found += static_cast<std::size_t>(met[i] & 1);
        }
      } else {
        for (std::uint32_t i = 4; i-- > 0;) {
          open[count] = node.child[i];
          count += static_cast<std::size_t>(met[i] & 1);
        }
      }
    }
    items.resize(found);
  }

 private:
  struct Node {
    FourBoxes boxes;
    std::array<std::uint32_t, 4>
        child{};  // nodes, or the items of a leaf; where there are fewer, none is met
    bool leaf = false;
  };

  class Builder;
  std::vector<Node> nodes_;
};

}  // namespace affskel::core
