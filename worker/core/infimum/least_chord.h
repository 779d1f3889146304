#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>

#include "core/base/none.h"
#include "core/base/vec3.h"
#include "core/infimum/piece_input.h"

namespace affskel::core {

class SaddleSearch;

/// A plane through x whose piece is the least of all planes near it.
struct LeastChord {
  double erosion = std::numeric_limits<double>::infinity();  ///< volume of the piece, scaled units
  double area = 0;                                           ///< of its lids
  double slope = 0;                                          ///< |grad E|: area plus the saddles' multipliers
  Vec3 normal;                                               ///< of the plane, away from the piece
  /// Vertices that the plane just touches, and at which the piece would grow by a part: PieceInput's numbers;
  /// none, one or two.
  std::array<std::uint32_t, 2> saddles{kNone, kNone};

  int kind() const { return (saddles[0] != kNone) + (saddles[1] != kNone); }
};

/// Whether two planes are so near to each other that one descent leads from both to one piece, mostly.
bool alike(const LeastChord& a, const LeastChord& b);

/// What the plane of a piece promises to cut off when it is moved from x to x + way: E^(1/3) goes on along its
/// gradient.  That is concave where pieces are convex (Brunn and Minkowski), so that less is cut off, if no part
/// joins.
double promised(const LeastChord& piece, const Vec3& way);

/// When a descent is given up.
struct DescentBound {
  double first = std::numeric_limits<double>::infinity();    ///< the first piece is greater
  double erosion = std::numeric_limits<double>::infinity();  ///< the least one is going to be greater
  double promise = 4;  ///< what steps to come may gain, in gains of the next one
};

/// Goes down from one plane to another until none near it has a lesser piece.
///
/// The volume is smooth where the plane meets no saddle, and jumps up where it passes one at which another
/// part joins the piece.  So the least piece is mostly a limit, at a plane that touches one saddle s or two,
/// with the constraint d.(s - x) >= 0.  An active-set Newton method (Nocedal and Wright 2006, chapter 16) in
/// coordinates of the plane's tilt, in which constraints are linear and derivatives exact (ChordPiece): a step
/// that raises the volume ends at the last saddle up to which it falls, which becomes active; one whose
/// multiplier is negative is let go.
///
/// Only sums, products, quotients and square roots are taken: the result is the same on every machine.
class ChordDescent {
 public:
  explicit ChordDescent(const PieceInput& input);
  ~ChordDescent();

  /// Goes down from the plane through x nearest to `start`'s that touches start's saddles.  Erosion infinite
  /// where x lies outside, within rounding, and when the way down does not promise to lead below the bound.
  LeastChord descend(const Vec3& x, const LeastChord& start, const DescentBound& bound = {});

  /// Looks across the saddles near a least piece for lesser ones, and from these again.
  /// @return the least piece found; `least` itself where there is no lesser one.
  LeastChord look_across(const Vec3& x, LeastChord least);

  /// For questions between descents.
  SaddleSearch& saddles();

  std::uint64_t evaluations() const;  ///< pieces found so far

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace affskel::core
