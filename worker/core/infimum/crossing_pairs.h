#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/groups.h"
#include "core/infimum/four_tree.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Pairs of triangles that pass through each other.  They join the parts of a solid below a plane that they belong
/// to, as soon as both have corners below it.  Immutable; threads share it.
///
/// Most pairs tell of a plane what is known without them: that the parts are joined by the surface between both
/// triangles, or by a pair next to it.  Each has a box, and where the plane does not meet that it is so, or nothing is
/// joined; and it has up to two vertices, and where one of them lies below it is so.
class CrossingPairs {
 public:
  struct Pair {
    std::uint32_t first = 0, second = 0;  ///< triangles
    friend auto operator<=>(const Pair&, const Pair&) = default;
  };

  CrossingPairs() = default;

  /// @param mates of half-edges 3 t + i; @param rings neighbours of vertices.
  CrossingPairs(const Mesh& mesh, std::span<const std::uint32_t> mates, const Groups<std::uint32_t>& rings,
                std::vector<Pair> pairs);

  bool empty() const { return pairs_.empty(); }

  /// Those with a triangle at the vertex: that one is first.
  std::span<const Pair> at(std::uint32_t vertex) const {
    return empty() ? std::span<const Pair>() : at_[vertex];
  }

  /// Calls visit(pair) for those that may tell something new of the plane of normal d through x.
  /// @param below whether a vertex lies below the plane.
  template <class Below, class Visit>
  void each_new(const Vec3& x, const Vec3& d, FourTree::Lists& lists, Below below, Visit visit) const {
    if (empty()) return;
    const PlaneHeights plane(x, d);
    const auto meets = [&](const FourBoxes& boxes) {
      const Four middle = plane.middle(boxes), reach = plane.reach(boxes);
      return (middle <= reach) & (middle >= -reach);
    };
    for (const std::uint32_t n : tree_.select(meets, lists)) {
      const std::array<std::uint32_t, 2>& links = links_[n];
      if (links[0] == kNone || !(below(links[0]) || below(links[1]))) visit(pairs_[n]);
    }
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  std::vector<Pair> pairs_;
  std::vector<std::array<std::uint32_t, 2>> links_;  // per pair: the vertices, or kNone
  Groups<Pair> at_;                                  // per vertex
  FourTree tree_;                                    // over pairs_
};

}  // namespace affskel::core
