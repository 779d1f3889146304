#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/vec3.h"
#include "core/infimum/piece_input.h"

namespace affskel::core {

/// Vertices nearer to a plane than this (scaled units) lie in it.
constexpr double kTouchHeight = 1e-12;

/// Bit i where corner i is below, of a triangle's heights.
inline unsigned sides_of(const std::array<double, 3>& height) {
  return (height[0] < -kTouchHeight ? 1U : 0U) | (height[1] < -kTouchHeight ? 2U : 0U) |
         (height[2] < -kTouchHeight ? 4U : 0U);
}

/// The section of a solid with the plane of normal d through x, as closed loops.  Its memory is used again.
///
/// Heights are d.(y - x), below means < 0; the section is seen from above and lies to the left of its loops.
/// Vertices within kTouchHeight of the plane lie above.
class SectionLoops {
 public:
  /// A point y of the plane: y - x = a u + b w.
  struct PlanePoint {
    double a = 0, b = 0;
  };

  /// A triangle that the plane cuts, and where its loop leaves it, by the edge that rises from below to above.
  struct Cut {
    std::uint32_t triangle = 0;
    std::uint32_t edge = 0;          ///< corner that the edge begins at
    std::array<double, 3> height{};  ///< within kTouchHeight may be < 0 above, too
    PlanePoint leaves;
  };

  struct Loop {
    std::uint32_t begin = 0, end = 0;  ///< of cuts()
    std::uint32_t shell = 0;
    double high_a = -std::numeric_limits<double>::infinity();
    double low_b = std::numeric_limits<double>::infinity(), high_b = -low_b;
    /// But for vertices that the plane touches, where loops may meet.
    PlanePoint rightmost{-std::numeric_limits<double>::infinity(), 0};
  };

  /// An edge of the vertices' tree that the plane cuts, by its end away from the root.
  struct TreeEdge {
    std::uint32_t child = 0, loop = 0;
    bool child_below = false;
  };

  explicit SectionLoops(const PieceInput& input);

  /// Finds the loops; what was found before is gone.  Costs as much as the plane cuts triangles, with a
  /// logarithm.
  void cut(const Vec3& x, const Vec3& d);

  const std::vector<Loop>& loops() const { return loops_; }
  const std::vector<Cut>& cuts() const { return cuts_; }  ///< loop by loop, each in order
  const std::vector<TreeEdge>& tree_edges() const { return tree_edges_; }
  /// Of PieceInput::Shell::handles: the vertex below and the loop.
  const std::vector<std::pair<std::uint32_t, std::uint32_t>>& handle_edges() const { return handle_edges_; }
  const Vec3& u() const { return u_; }
  const Vec3& w() const { return w_; }

  bool below(std::uint32_t vertex) const { return height(vertex) < -kTouchHeight; }

  /// The loop through which a ray from (a, b) to the right leaves the section first; kNone when it starts
  /// outside.  Only ways out count: where the plane touches an edge, two loops run along it, one of them the
  /// way in.
  /// @param of_lid which loops there are.
  template <class OfLid>
  std::uint32_t loop_right_of(const PlanePoint& start, OfLid of_lid) const {
    std::uint32_t nearest = PieceInput::kNone;
    double least = std::numeric_limits<double>::infinity();
    int winding = 0;
    for (std::uint32_t l = 0; l < loops_.size(); ++l) {
      if (!of_lid(l)) continue;
      crossings_right(loops_[l], start, [&](double at, bool out) {
        winding += out ? 1 : -1;
        if (!out || at >= least) return;
        least = at;
        nearest = l;
      });
    }
    return winding > 0 ? nearest : PieceInput::kNone;
  }

 private:
  double height(std::uint32_t vertex) const { return dot(d_, in_.mesh.points[vertex] - x_); }
  void collect();
  void trace(std::uint32_t start);

  // Where the loop passes the ray from a place to the right: calls visit(a there, whether b grows).
  template <class Visit>
  void crossings_right(const Loop& loop, const PlanePoint& start, Visit visit) const {
    const double b = start.b;
    if (b < loop.low_b || b > loop.high_b || loop.high_a < start.a) return;
    PlanePoint from = cuts_[loop.end - 1].leaves;
    for (std::uint32_t i = loop.begin; i < loop.end; ++i) {
      const PlanePoint to = cuts_[i].leaves;
      if ((from.b > b) != (to.b > b)) {
        const double at = from.a + (b - from.b) / (to.b - from.b) * (to.a - from.a);
        if (at > start.a) visit(at, to.b > from.b);
      }
      from = to;
    }
  }

  const PieceInput& in_;
  Vec3 x_, d_, u_, w_;
  std::vector<std::uint32_t> near_;  // triangles that may be cut
  std::vector<Cut> found_;           // in the order of the tree
  std::vector<std::uint32_t> mark_;  // per triangle: first_mark_ plus its place in found_
  std::uint32_t first_mark_ = 1;
  std::vector<std::uint8_t> traced_;  // per found_
  std::vector<Cut> cuts_;
  std::vector<Loop> loops_;
  std::vector<TreeEdge> tree_edges_;
  std::size_t tree_edge_count_ = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> handle_edges_;
};

}  // namespace affskel::core
