#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/infimum/piece_input.h"

namespace affskel::core {

/// Finds the vertices at which a plane through x that tilts may meet a part of the solid that joins the piece
/// below it: those whose neighbours below are of several stretches of their ring, or that are not alone in the
/// plane, or with which a triangle begins that passes through another.  Its memory is used again.
class SaddleSearch {
 public:
  struct Saddle {
    double at = 0;  ///< how far the plane tilts until it touches the vertex, see below
    std::uint32_t vertex = 0;
    friend bool operator<(const Saddle& a, const Saddle& b) {
      return a.at != b.at ? a.at < b.at : a.vertex < b.vertex;
    }
  };

  explicit SaddleSearch(const PieceInput& input);

  /// Those above the plane of normal d, or in it, that are below the one of normal `end`, by the share of the
  /// way from d to `end`.
  const std::vector<Saddle>& sinking(const Vec3& x, const Vec3& d, const Vec3& end,
                                     std::span<const std::uint32_t> but);

  /// Those below the plane of normal d that it touches after the least tilts, by the sine of the tilt.
  /// Looks no further than the tilt that passes some hundred vertices.
  const std::vector<Saddle>& just_below(const Vec3& x, const Vec3& d);

  /// The `count` vertices nearest to x at which parts may meet, or all; by the square of their distance.
  const std::vector<Saddle>& nearest(const Vec3& x, std::size_t count);

  /// Those that a plane of a normal at most asin(sine) from d touches, where parts may meet at such a plane.
  std::span<const PieceInput::Saddle* const> in_reach(const Vec3& x, const Vec3& d, double sine);

  /// Whether the saddle is one for planes of normal d, of any length; no ring is looked at.
  bool near_tangent(const PieceInput::Saddle& saddle, const Vec3& d) const {
    if (!in_.crossings.at(saddle.vertex).empty()) return true;
    const double along = dot(d, saddle.normal);
    return along * along >= saddle.cosine * saddle.cosine * dot(d, d);
  }

  /// Whether parts of the solid may meet at the saddle when the plane through x of normal d, which touches it,
  /// tilts.
  bool may_join(const Vec3& x, const PieceInput::Saddle& saddle, const Vec3& d);

 private:
  Vec3 from_x(std::uint32_t vertex) const { return in_.mesh.points[vertex] - x_; }
  bool may_join(const PieceInput::Saddle& saddle, const Vec3& d);
  bool parts_ring(const PieceInput::Saddle& saddle, const Vec3& d) const;
  bool crossing_joins(std::uint32_t vertex, const Vec3& d);
  bool begins_with(std::uint32_t triangle, std::uint32_t vertex, const Vec3& d) const;
  bool are_near_below(std::span<const std::uint32_t> vertices, const Vec3& d);
  template <class Meets, class Visit>
  void visit_vertices(Meets meets, Visit visit);

  const PieceInput& in_;
  double furthest_;       // tilt that just_below() looks at
  double radius_ = 0.05;  // that nearest() looks at first, of no effect on what it finds
  Vec3 x_;
  FourTree::Lists lists_;
  std::vector<Saddle> found_;
  std::vector<const PieceInput::Saddle*> reached_;
  std::vector<std::uint32_t> meeting_, seen_;  // of crossing_joins()
  std::vector<std::uint32_t> seen_by_;         // per vertex: the look that saw it last
  std::uint32_t look_ = 0;
};

}  // namespace affskel::core
