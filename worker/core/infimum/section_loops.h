#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/base/none.h"
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
  struct Cut {
    PlanePoint leaves;
    std::uint32_t edge = 0;  ///< the half-edge 3 t + i that it is left by

    std::uint32_t triangle() const { return edge / 3; }
  };

  struct Loop {
    std::uint32_t begin = 0, end = 0;              ///< of cuts()
    std::uint32_t alone_begin = 0, alone_end = 0;  ///< of alone_first()
    std::uint32_t low = 0;                         ///< a vertex below, of an edge that it passes
    double area = 0;                               ///< of what it runs round, to its left
    std::array<double, 2> moment{};                ///< first, of the same, about x
    /// What the corners that are alone below add to a volume with the origin x, less those that are alone above.
    double volume = 0;
    PlanePoint least, most;  ///< corners of the box round it
  };

  /// One of PieceInput::edges that a loop passes.
  struct Edge {
    std::uint32_t number = 0, loop = 0;
    std::uint32_t low = 0;  ///< its end below
  };

  explicit SectionLoops(const PieceInput& input);

  /// Where a loop can be followed from: of one of PieceInput::edges that the plane cuts the half-edge that rises.
  struct Start {
    std::uint32_t edge = 0, half_edge = 0;
  };

  /// Finds the starts; what was found before is gone.  Costs as much as there are, with a logarithm.
  void cut(const Vec3& x, const Vec3& d);

  /// Adds the loops of those starts that no loop passes and that wanted(start) asks for.  Costs as much as they pass
  /// triangles.
  template <class Wanted>
  void trace_if(Wanted wanted) {
    for (const Start& start : starts_.all()) {
      if (passed_[start.edge] != number_ && wanted(start)) trace(start.half_edge);
    }
  }

  /// Adds the loop of the start nearest to x: mostly the one round it.
  void trace_nearest() {
    if (starts_.count > 0) trace(nearest_.half_edge);
  }

  /// Where the loop of a start passes its edge.
  PlanePoint place(const Start& start) const {
    const Two at = passed(corner(in_.begin_of(start.half_edge)), corner(in_.end_of(start.half_edge)));
    return {at[0], at[1]};
  }

  const std::vector<Loop>& loops() const { return loops_; }
  std::span<const Cut> cuts() const { return cuts_.all(); }  ///< loop by loop, each in order
  /// Half-edges by which triangles are left whose first corner is alone: 3 t where it is below, else 3 t + 2.
  std::span<const std::uint32_t> alone_first() const { return alone_first_.all(); }
  std::span<const Edge> edges() const { return edges_.all(); }
  const Vec3& u() const { return u_; }
  const Vec3& w() const { return w_; }

  /// Where a loop is furthest to the right, but for vertices that the plane touches, where loops may meet.
  PlanePoint rightmost(const Loop& loop) const;

  /// Adds the integral of (y - x)(y - x)^T cot(inclination of the wall) along a loop: 00, 01, 11.
  void add_bend(const Loop& loop, std::array<double, 3>& sum) const;

  bool below(std::uint32_t vertex) const { return height(vertex) < -kTouchHeight; }

  /// The loop through which a ray from (a, b) to the right leaves the section first; kNone when it starts
  /// outside.  Only ways out count: where the plane touches an edge, two loops run along it, one of them the
  /// way in.
  /// @param of_lid which loops there are.
  template <class OfLid>
  std::uint32_t loop_right_of(const PlanePoint& start, OfLid of_lid) const {
    std::uint32_t nearest = kNone;
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
    return winding > 0 ? nearest : kNone;
  }

 private:
  // Both coordinates of a PlanePoint, worked on at once.
  using Two = double __attribute__((vector_size(16)));
  using Axes = std::array<Two, 3>;  // u and w, by coordinate of space

  // A list with room for all that there may be, and for one more: whether an item is kept takes no branch.  What is
  // never written takes no memory of the machine.
  template <class Item>
  struct List {
    explicit List(std::size_t room)
        : bytes(std::make_unique_for_overwrite<std::byte[]>((room + 1) * sizeof(Item))),
          items(reinterpret_cast<Item*>(bytes.get())) {}
    std::span<const Item> all() const { return {items, count}; }
    Item* end() { return items + count; }
    void end_at(const Item* end) { count = static_cast<std::uint32_t>(end - items); }
    std::unique_ptr<std::byte[]> bytes;
    Item* items;
    std::uint32_t count = 0;
  };

  // A vertex in the plane's axes.
  struct Corner {
    Two at;
    double height = 0;
    std::uint32_t vertex = 0;
  };

  double spread(std::uint32_t triangle, const PlanePoint& stretch) const;
  double height(std::uint32_t vertex) const { return dot(d_, in_.mesh.points[vertex] - x_); }
  Corner corner(std::uint32_t vertex) const { return corner(vertex, x_, d_, axes_); }
  Corner corner(std::uint32_t vertex, const Vec3& x, const Vec3& d, const Axes& axes) const {
    const Vec3 y = in_.mesh.points[vertex] - x;
    return {axes[0] * y.x + axes[1] * y.y + axes[2] * y.z, dot(d, y), vertex};
  }
  // Where the edge between two vertices, the first below, passes the plane.
  static Two passed(const Corner& low, const Corner& high) {
    return low.at + low.height / (low.height - high.height) * (high.at - low.at);
  }
  void trace(std::uint32_t start);

  // Where the loop passes the ray from a place to the right: calls visit(a there, whether b grows).
  template <class Visit>
  void crossings_right(const Loop& loop, const PlanePoint& start, Visit visit) const {
    const double b = start.b;
    if (b < loop.least.b || b > loop.most.b || loop.most.a < start.a) return;
    PlanePoint from = cuts_.items[loop.end - 1].leaves;
    for (std::uint32_t i = loop.begin; i < loop.end; ++i) {
      const PlanePoint to = cuts_.items[i].leaves;
      if ((from.b > b) != (to.b > b)) {
        const double at = from.a + (b - from.b) / (to.b - from.b) * (to.a - from.a);
        if (at > start.a) visit(at, to.b > from.b);
      }
      from = to;
    }
  }

  const PieceInput& in_;
  Vec3 x_, d_, u_, w_;
  Axes axes_;
  FourTree::Lists lists_;
  std::vector<std::uint32_t> passed_;  // per edge: the section in which it was passed last
  std::uint32_t number_ = 0;           // of the section
  List<Start> starts_;
  Start nearest_;
  List<Cut> cuts_;
  List<std::uint32_t> alone_first_;
  List<Edge> edges_;
  std::vector<Loop> loops_;
};

}  // namespace affskel::core
