#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/box.h"
#include "core/spatial/halved_nodes.h"

namespace affskel::core {

/// The boxes that the way from a place on, t * way for t of 0 to `last`, comes within `slack` of, along each axis.
struct WayQuery {
  Vec3 from, way;
  double slack = 0;
  double last = 1;

  bool meets(const Box& box) const;
};

/// A balanced tree over boxes for overlap queries: self-intersection, rays, membership.  Immutable after
/// construction; queries from several threads are safe.
class BoxTree {
 public:
  BoxTree() = default;
  /// O(N log N), on up to `threads` threads.
  explicit BoxTree(std::vector<Box> boxes, unsigned threads = 1);

  /// The box that was given with this index.
  const Box& box(std::uint32_t index) const { return boxes_[index]; }

  /// Calls visit(index) for every box that meets `query`, in an order of the tree's own.
  /// @param query a Box, or anything that tells by meets(Box) whether it may meet what is in a box.
  template <class Query = Box, class Visit>
  void visit(const Query& query, Visit visit) const {
    visit_above(query, -1, visit);
  }

  /// The same for the indices > `above`.
  template <class Query = Box, class Visit>
  void visit_above(const Query& query, std::int64_t above, Visit visit) const {
    tree_.visit_above(
        above, [&](const Box& box) { return query.meets(box); },
        [&](std::uint32_t item) {
          if (query.meets(boxes_[item])) visit(item);
        });
  }

 private:
  std::vector<Box> boxes_;
  HalvedTree<Box> tree_;
};

}  // namespace affskel::core
