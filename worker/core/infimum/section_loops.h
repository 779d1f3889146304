#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/vec3.h"
#include "core/infimum/piece_input.h"

namespace affskel::core {

/// Vertices nearer to a plane than this (scaled units) lie in it.
constexpr double kTouchHeight = 1e-12;

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
  /// One corner is alone on its side.
  struct Cut {
    PlanePoint leaves;
    double alone = 0;                ///< distance of that corner from the plane; 0 where that just touches it
    std::array<double, 2> others{};  ///< distances of the other two
    std::uint32_t edge = 0;          ///< the half-edge 3 t + i that it is left by
    std::uint32_t corner = 0;        ///< the vertex that is alone
    bool corner_below = false;

    std::uint32_t triangle() const { return edge / 3; }
    /// Whether the triangle's first corner is below.
    bool first_below() const {
      const std::uint32_t begin = edge - 3 * triangle();
      return begin == 0 || (begin == 1 && !corner_below);
    }
  };

  struct Loop {
    std::uint32_t begin = 0, end = 0;  ///< of cuts()
    std::uint32_t low = 0;             ///< a vertex below, of an edge that it passes
    double area = 0;                   ///< of what it runs round, to its left
    std::array<double, 2> moment{};    ///< first, of the same, about x
    double high_a = -std::numeric_limits<double>::infinity();
    double low_b = std::numeric_limits<double>::infinity(), high_b = -low_b;
    /// But for vertices that the plane touches, where loops may meet.
    PlanePoint rightmost{-std::numeric_limits<double>::infinity(), 0};
  };

  /// One of PieceInput::edges that the plane cuts.
  struct Edge {
    std::uint32_t number = 0, loop = 0;
    bool begin_below = false;  ///< whether the first of its half-edges rises
  };

  explicit SectionLoops(const PieceInput& input);

  /// Finds the loops; what was found before is gone.  Costs as much as the plane cuts triangles, with a
  /// logarithm.
  void cut(const Vec3& x, const Vec3& d);

  const std::vector<Loop>& loops() const { return loops_; }
  const std::vector<Cut>& cuts() const { return cuts_; }  ///< loop by loop, each in order
  const std::vector<Edge>& edges() const { return edges_; }
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
  // Both coordinates of a PlanePoint, worked on at once.
  using Two = double __attribute__((vector_size(16)));

  // A vertex in the plane's axes.
  struct Corner {
    Two at;
    double height = 0;
    std::uint32_t vertex = 0;
  };

  double height(std::uint32_t vertex) const { return dot(d_, in_.mesh.points[vertex] - x_); }
  Corner corner(std::uint32_t vertex) const;
  static Two passed(const Corner& low, const Corner& high);
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
  std::array<Two, 3> axes_;  // u and w, by coordinate of space
  FourTree::Lists lists_;
  std::vector<std::uint32_t> passed_;  // per edge: the section in which it was passed last
  std::uint32_t number_ = 0;           // of the section
  std::vector<Cut> cuts_;
  std::vector<Loop> loops_;
  std::vector<Edge> edges_;
};

}  // namespace affskel::core
