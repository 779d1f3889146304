#pragma once

#include <cstdint>
#include <vector>

#include "core/base/none.h"
#include "core/mesh/mesh.h"
#include "core/spatial/box_tree.h"
#include "core/spatial/oriented_box_tree.h"

namespace affskel::core {

/// Finds the triangles that come close to a triangle, by bounding boxes.
///
/// Most triangles have axis-parallel boxes.  Slivers (long, thin and oblique) have oriented ones: the
/// axis-parallel boxes of the sides of a tilted cylinder nearly all meet.  In a large fan, the triangles
/// round one vertex, all boxes meet at the vertex; so its triangles are compared by the boxes of the arcs
/// that their opposite sides draw on a unit sphere round the vertex.
///
/// Immutable after construction; queries from several threads are safe.
class CloseTriangles {
 public:
  /// O(N log N), on up to `threads` threads.  Keeps references to the mesh and to the boxes.
  /// @param boxes of the mesh's triangles.
  CloseTriangles(const Mesh& mesh, const std::vector<Box>& boxes, unsigned threads = 1);

  /// Calls visit(j), once or several times, for every triangle j > i that has a point in common with triangle
  /// i, or one beside their shared vertex when they share exactly one, neither being degenerate; and for
  /// others nearby.
  template <class Visit>
  void visit_above(std::uint32_t i, Visit visit) const {
    if (groups_.empty()) return loose_.tree.visit_above(boxes_[i], i, visit);
    const std::uint32_t home = group_of_[i];
    const Corners corners = triangles_.corners(i);
    const Query query{boxes_[i], oriented_box(corners), triangles_.unit()};
    const std::int64_t above = std::int64_t{loose_.members.count_up_to(i)} - 1;
    const auto visit_loose = [&](std::uint32_t k) { visit(loose_.members.index[k]); };
    if (home == kNone) {
      loose_.tree.visit_above(boxes_[i], above, visit_loose);
    } else {
      loose_.tree.visit_above(query, above, visit_loose);
    }
    group_tree_.visit(query, [&](std::uint32_t g) {
      const Group& group = groups_[g];
      if (g != home || !group.is_fan()) return group.tree.visit_above(i, corners, query.oriented, visit);
      const std::uint32_t local = group.members.count_up_to(i) - 1;
      group.arcs.visit_above(group.arcs.box(local), local,
                             [&](std::uint32_t k) { visit(group.members.index[k]); });
    });
  }

 private:
  /// Some triangles, ascending, which a tree numbers from 0.
  struct Members {
    std::vector<std::uint32_t> index;
    /// The number of members <= i.
    std::uint32_t count_up_to(std::uint32_t i) const;
  };

  /// A large fan, or all slivers that are in none.
  struct Group {
    std::uint32_t vertex = kNone;  // of a fan
    Members members;
    OrientedBoxTree tree;
    BoxTree arcs;  // of a fan
    bool is_fan() const { return vertex != kNone; }
  };

  struct Loose {
    Members members;
    BoxTree tree;
  };

  /// What a triangle's own box and the oriented one round it both meet.
  struct Query {
    const Box& box;
    OrientedBox oriented;
    double unit;
    bool meets(const Box& other) const {
      return box.meets(other) && !surely_apart(oriented, oriented_box(other, unit));
    }
  };

  void assign_groups(const Mesh& mesh);

  const std::vector<Box>& boxes_;
  UnitTriangles triangles_;
  std::vector<Group> groups_;
  std::vector<std::uint32_t> group_of_;  // per triangle, or kNone; empty without groups
  Loose loose_;         // the triangles of no group; `members` stays empty when there is no group
  BoxTree group_tree_;  // over the boxes of whole groups
};

}  // namespace affskel::core
