#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/box.h"

namespace affskel::core {

/// Four numbers that are worked on at once (a vector type of GCC and Clang).
using Four = float __attribute__((vector_size(16)));
/// Whether, of each of four: -1 or 0.
using FourAnswers = int __attribute__((vector_size(16)));

/// The same as bits, the first one lowest.
inline unsigned bits_of(const FourAnswers& answers) {
#ifdef __SSE__
  return static_cast<unsigned>(__builtin_ia32_movmskps((Four)answers));  // one instruction for fourteen
#else
  unsigned bits = 0;
  for (unsigned i = 0; i < 4; ++i) bits |= (answers[i] != 0 ? 1U : 0U) << i;
  return bits;
#endif
}

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
  /// Whether the plane may pass boxes, or the segments between their lowest and highest corners.
  FourAnswers passes(const FourBoxes& boxes) const { return is_within(middle(boxes), reach(boxes)); }
  FourAnswers passes_segments(const FourBoxes& boxes) const {
    return is_within(middle(boxes), reach_of_segment(boxes));
  }
  /// How far the segment between its lowest and highest corner reaches from its middle at most.
  Four reach_of_segment(const FourBoxes& boxes) const {
    const Four reach = boxes.half[0] * d_[0] + boxes.half[1] * d_[1] + boxes.half[2] * d_[2];
    return size_of(reach) + kSlack;
  }
  /// How far the box reaches from its middle at most.
  Four reach(const FourBoxes& boxes) const {
    return boxes.half[0] * size_[0] + boxes.half[1] * size_[1] + boxes.half[2] * size_[2] + kSlack;
  }

  /// No less than the distance of any point of a box from x, for all boxes.
  static Four distance(const FourBoxes& boxes, const Vec3& x) {
    Four sum = boxes.half[0] + boxes.half[1] + boxes.half[2] + kSlack;
    for (std::size_t k = 0; k < 3; ++k) {
      const Four away = boxes.centre[k] - static_cast<float>(x[k]);
      sum += size_of(away);
    }
    return sum;
  }

  /// No less than the square of the distance of any point of a box from x, for all boxes; of none 0.
  static Four distance_squared(const FourBoxes& boxes, const Vec3& x) {
    Four sum = {0, 0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      const Four away = boxes.centre[k] - static_cast<float>(x[k]);
      const Four most = size_of(away) + boxes.half[k] + kSlack;
      sum += most > 0 ? most * most : Four{};
    }
    return sum;
  }

  /// No more than the distance of any point of a box from x.
  static Four gap(const FourBoxes& boxes, const Vec3& x) {
    Four most = {0, 0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      const Four away = boxes.centre[k] - static_cast<float>(x[k]);
      const Four outside = size_of(away) - boxes.half[k] - kSlack;
      most = outside > most ? outside : most;
    }
    return most;
  }

 private:
  // Without their signs.
  static Four size_of(const Four& four) { return (Four)((FourAnswers)four & 0x7FFFFFFF); }
  static FourAnswers is_within(const Four& middle, const Four& reach) { return size_of(middle) <= reach; }

  std::array<float, 3> d_, size_;
  float offset_;
};

/// A tree of boxes, four to a node, for queries by planes; all its leaves are equally deep.  Immutable once it
/// is built.
class FourTree {
 public:
  /// Memory of select(), used again.
  using Lists = std::array<std::vector<std::uint32_t>, 2>;

  /// @param boxes of segments, too: with their ends as low and high, whichever is lower.
  /// @return the items in the tree's order: neighbours near each other.
  std::vector<std::uint32_t> build(const std::vector<Box>& boxes);

  /// The items, in the tree's order, whose box meets(boxes) tells of with -1, not 0, of four that it is asked
  /// for at once.  Level by level, without branches on what is met: no processor foresees them.
  /// @param meets_item is asked in its place of the items' own boxes.
  /// @return in one of the lists.
  template <class Meets, class MeetsItem>
  std::span<const std::uint32_t> select(Meets meets, MeetsItem meets_item, Lists& lists) const {
    lists[0].assign(1, 0);
    std::size_t count = 1;
    for (std::size_t l = 0; l + 1 < levels_.size(); ++l) count = descend(levels_[l], count, meets, lists);
    count = descend(levels_.back(), count, meets_item, lists);
    return {lists[0].data(), count};
  }
  template <class Meets>
  std::span<const std::uint32_t> select(Meets meets, Lists& lists) const {
    return select(meets, meets, lists);
  }

 private:
  // Which of four are met, those first.
  struct Met {
    std::array<std::uint8_t, 4> place;
    std::uint8_t count;
  };
  static constexpr std::array<Met, 16> kMet = [] {
    std::array<Met, 16> all{};
    for (unsigned bits = 0; bits < 16; ++bits)
      for (std::uint8_t place = 0; place < 4; ++place)
        if ((bits >> place & 1U) != 0) all[bits].place[all[bits].count++] = place;
    return all;
  }();

  struct Node {
    FourBoxes boxes;
    std::array<std::uint32_t, 4> child{};  // of the next level, or items; where there are fewer, none is met
  };

  // From the nodes listed to those of their children that are met; how many.
  template <class Meets>
  static std::size_t descend(const std::vector<Node>& level, std::size_t count, Meets meets, Lists& lists) {
    auto& [from, to] = lists;
    if (to.size() < 4 * count) to.resize(4 * count);
    std::uint32_t* end = to.data();
    for (std::size_t n = 0; n < count; ++n) {
      const Node& node = level[from[n]];
      const Met& met = kMet[bits_of(meets(node.boxes))];
      end[0] = node.child[met.place[0]];
      end[1] = node.child[met.place[1]];
      end[2] = node.child[met.place[2]];
      end[3] = node.child[met.place[3]];
      end += met.count;
    }
    const auto met_count = static_cast<std::size_t>(end - to.data());
    from.swap(to);
    return met_count;
  }

  class Builder;
  std::vector<std::vector<Node>> levels_;  // from the root
};

}  // namespace affskel::core
