#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/box_tree.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Finds the triangles that come close to a triangle, by bounding boxes.
///
/// Plain boxes fail in large fans, the triangles round a vertex with very many: their boxes all hold the
/// vertex, and as slivers are long and oblique, boxes of a fan on the base of a cone meet nearly all boxes of
/// its side.  Hence each large fan has boxes of its own: two of its triangles are compared as seen from the
/// vertex, by boxes round the arcs that their opposite sides draw on the unit sphere; and they are compared
/// with other triangles piece by piece, pieces getting shorter towards the opposite side.
///
/// Immutable after construction; queries from several threads are safe.
class CloseTriangles {
 public:
  /// O(N log N), on up to `threads` threads.  Keeps a reference to the boxes.  @param boxes of the mesh's
  /// triangles.
  CloseTriangles(const Mesh& mesh, const std::vector<Box>& boxes, unsigned threads = 1);

  /// Calls visit(j), once or several times, for every triangle j > i that has a point in common with triangle
  /// i, or one beside their shared vertex when they share exactly one, neither being degenerate; and for
  /// others nearby.
  template <class Visit>
  void visit_above(std::uint32_t i, Visit visit) const {
    if (fans_.empty()) return loose_.tree.visit_above(boxes_[i], i, visit);
    const std::uint32_t home = fan_of_[i];
    if (home == kNone) return visit_strangers(boxes_[i], i, home, visit);
    const Fan& fan = fans_[home];
    const std::uint32_t local = fan.members.behind(i) - 1;
    for (std::uint32_t p = fan.first_piece[local]; p < fan.first_piece[local + 1]; ++p) {
      visit_strangers(fan.pieces[p], i, home, visit);
    }
    fan.arc_tree.visit_above(fan.arcs[local], local, [&](std::uint32_t k) { visit(fan.members.index[k]); });
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  /// Some triangles, ascending, which a tree numbers from 0.
  struct Members {
    std::vector<std::uint32_t> index;
    /// The number of members <= i.
    std::uint32_t behind(std::uint32_t i) const;
  };

  struct Fan {
    std::uint32_t vertex = 0;
    Members members;
    std::vector<Box> arcs, pieces;
    std::vector<std::uint32_t> first_piece, piece_member;
    BoxTree arc_tree, piece_tree;
  };

  struct Loose {
    Members members;
    BoxTree tree;
  };

  void assign_fans(const Mesh& mesh);
  void cut(const Mesh& mesh, Fan& fan, unsigned threads) const;

  /// Triangles outside of fan `home` whose boxes meet `query`.
  template <class Visit>
  void visit_strangers(const Box& query, std::uint32_t i, std::uint32_t home, Visit visit) const {
    loose_.tree.visit_above(query, std::int64_t{loose_.members.behind(i)} - 1,
                            [&](std::uint32_t k) { visit(loose_.members.index[k]); });
    fan_tree_.visit(query, [&](std::uint32_t f) {
      if (f == home) return;
      const Fan& fan = fans_[f];
      fan.piece_tree.visit_above(query, std::int64_t{fan.first_piece[fan.members.behind(i)]} - 1,
                                 [&](std::uint32_t p) { visit(fan.members.index[fan.piece_member[p]]); });
    });
  }

  const std::vector<Box>& boxes_;
  std::vector<Fan> fans_;
  std::vector<std::uint32_t> fan_of_;  // per triangle, or kNone; empty without fans
  Loose loose_;                        // the triangles of no large fan; members empty when these are all
  BoxTree fan_tree_;                   // over the boxes of whole fans
};

}  // namespace affskel::core
