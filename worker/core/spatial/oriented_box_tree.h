#pragma once

#include <cstdint>
#include <vector>

#include "core/spatial/halved_nodes.h"
#include "core/spatial/oriented_box.h"

namespace affskel::core {

/// A balanced tree of oriented boxes over triangles, for slivers: around long and thin triangles that lie
/// side by side, oriented boxes stay thin whatever their direction (Gottschalk, Lin and Manocha 1996).
/// Immutable after construction; queries from several threads are safe.
class OrientedBoxTree {
 public:
  OrientedBoxTree() = default;
  /// O(N log N), on up to `threads` threads.  Keeps a reference to the mesh of `triangles`.
  /// @param members some of its triangles.
  OrientedBoxTree(const UnitTriangles& triangles, std::vector<std::uint32_t> members, unsigned threads = 1);

  /// Calls visit(j) for every member j > i that may meet triangle i, in an order of the tree's own.
  /// @param corners, box of triangle i, a member or not.
  template <class Visit>
  void visit_above(std::uint32_t i, const Corners& corners, const OrientedBox& box, Visit visit) const {
    tree_.visit_above(
        i, [&](const OrientedBox& node) { return !surely_apart(node, corners) && !surely_apart(box, node); },
        [&](std::uint32_t j) {
          if (!surely_apart(box, triangles_.corners(j))) visit(j);
        });
  }

 private:
  UnitTriangles triangles_;
  HalvedTree<OrientedBox> tree_;
};

}  // namespace affskel::core
