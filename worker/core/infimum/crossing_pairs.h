#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/groups.h"
#include "core/base/none.h"
#include "core/infimum/crossing_links.h"
#include "core/infimum/four_tree.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Pairs of triangles that pass through each other, and which of them to ask when a plane parts a solid: most tell of
/// it what is known without them (CrossingPair).  Immutable; threads share it.
class CrossingPairs {
 public:
  CrossingPairs() = default;

  /// @param rings neighbours of vertices.
  CrossingPairs(const Mesh& mesh, const Groups<std::uint32_t>& rings, std::vector<CrossingPair> pairs);

  bool empty() const { return pairs_.empty(); }

  struct Crossing {
    std::uint32_t triangle = 0, other = 0;
  };
  /// Those of triangles at the vertex.
  std::span<const Crossing> at(std::uint32_t vertex) const {
    return empty() ? std::span<const Crossing>() : at_[vertex];
  }

  /// Calls visit(pair) for those that may tell something new of the plane of normal d through x.
  /// @param below whether a vertex lies below the plane.
  template <class Below, class Visit>
  void each_new(const Vec3& x, const Vec3& d, FourTree::Lists& lists, Below below, Visit visit) const {
    if (empty()) return;
    const PlaneHeights plane(x, d);
    const auto meets = [&](const FourBoxes& boxes) { return plane.passes(boxes); };
    for (const std::uint32_t n : tree_.select(meets, lists)) {
      const CrossingPair& pair = pairs_[n];
      if (pair.links[0] == kNone || !(below(pair.links[0]) || below(pair.links[1]))) visit(pair);
    }
  }

 private:
  std::vector<CrossingPair> pairs_;
  Groups<Crossing> at_;  // per vertex
  FourTree tree_;        // over pairs_: boxes that planes meet of which they may tell something new
};

}  // namespace affskel::core
