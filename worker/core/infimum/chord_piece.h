#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "core/base/vec3.h"
#include "core/infimum/piece_input.h"

namespace affskel::core {

/// The chordal piece of x for the unit direction d: the part of { y in V : d.y < d.x } that x is joined with.
/// What only touches the plane (kTouchHeight) lies above it: a piece does not reach through a saddle that the plane just
/// touches, which is the lower of the two limits there.
///
/// Derivatives are those by t, two coordinates of the plane's tilt: the plane (d + t_0 u + t_1 w).(y - x) = 0.
/// In them both are exact: the gradient is minus the section's first moment, the second derivative the
/// integral of (y - x)(y - x)^T cot(inclination of the wall) along the rim.
struct ChordPiece {
  bool found = false;  ///< false where x lies outside, within rounding
  double volume = 0;   ///< chord(x, d), scaled units
  double area = 0;     ///< of all lids of the piece
  Vec3 u, w;           ///< with d an orthonormal basis
  std::array<double, 2> gradient{};
};

/// Second derivatives 00, 01, 11.
using Hessian = std::array<double, 3>;

/// Finds pieces one after another, reusing its memory.  One per thread.
///
/// Cost: proportional to the triangles that the plane cuts, with a logarithm for finding them.  Of the surface
/// below the plane only sums are asked for (PieceInput).
class PieceFinder {
 public:
  explicit PieceFinder(const PieceInput& input);
  ~PieceFinder();

  /// @param d of unit length.
  ChordPiece find(const Vec3& x, const Vec3& d);

  /// Of the piece found last.
  Hessian hessian() const;

  /// Whether the piece found last holds a vertex that lies below its plane.
  bool holds(std::uint32_t vertex);

  enum class Joins { no, yes, unknown };
  /// Whether another part joins the piece found last at a vertex that its plane touches, as soon as it passes it.
  /// Unknown where parts may meet elsewhere, too: at a neighbour in the plane, or where triangles pass through
  /// each other.
  Joins joins_at(std::uint32_t vertex);

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace affskel::core
