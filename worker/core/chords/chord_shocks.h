#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

// Notation.  x and y are the ends of a lattice edge, delta = y - x, g_x and g_y the gradients of E there.
// Near a shock E is the minimum of two smooth functions, the two equal chords; their tangents at x and y
// cross at x + t delta,  t = (E_y - E_x - g_y.delta) / s,  with the kink  s = (g_x - g_y).delta.
// All in the coordinates of the lattice's frame (see frame_field.h).

struct ChordShockOptions {
  /// Least relative strength r = s / (|g_x.delta| + |g_y.delta|), 0 <= r <= 1.  The same shock has r near 1
  /// on the edges across it and a small r on those along it, so that a high bound (0.5, say) tears holes
  /// into a slanting sheet; what tells shocks from facets is the opening.
  double min_strength = 0.05;
  /// Least opening o = (1 - n_x.n_y) / 2 of the two normals, 0 (equal) .. 1 (opposite); 0.005 is an angle of
  /// 8 degrees.  The facets that a finite direction set cuts into the level surfaces of E are shocks, too;
  /// which ones matter is for measure_turns() and significant_shocks() to say.
  double min_opening = 0.005;
  /// How far outside [0, 1] t may lie; it is then moved to the nearer end.  The branches bend between x and
  /// y, and a third one may come between them: without slack one crossing in fifteen is missed, and
  /// each leaves a hole.  A larger slack takes jumps of E for shocks.
  double slack = 0.25;
};

/// A point where two equal chords meet, on a lattice edge.
struct ChordShock {
  std::uint32_t point = 0;               ///< rank of the sample point x, the edge's lower end
  std::uint32_t upper = 0;               ///< rank of y
  std::uint8_t axis = 0;                 ///< of the edge, 0 .. 2
  std::array<std::uint32_t, 3> place{};  ///< lattice indices of x
  double t = 0;                          ///< 0 .. 1
  Vec3 position;                         ///< x + t delta, frame coordinates; always inside the solid
  double erosion = 0;                    ///< E there, volume
  double strength = 0;                   ///< r
  double opening = 0;                    ///< o, of the edge's own ends
  double turn = 0;                   ///< the same over a band across the sheet, see measure_turns(); o before
  Vec3 gradient_low, gradient_high;  ///< g_x and g_y; the sheet's normal is along their difference
  std::uint32_t direction_low = 0, direction_high = 0;  ///< indices of the two optimal directions
};

/// The shocks of E on all lattice edges between neighbouring sample points whose segment lies in the solid,
/// straight from the definition of the affine skeleton (Zografos 2003, section 3.4): points with two equal
/// optimal chords.  Below the spacing in accuracy, without a derivative of the normals and without a length
/// scale.  In the order of (point, axis).
///
/// E, t, s and r are affinely invariant: g.delta pairs a covector with a vector, so that a lattice mapped
/// along with the solid gives the same numbers.  The opening is not: an angle between covectors needs a
/// metric.  It is invariant only when the frame's metric is mapped along, as in the `affine` frame.
///
/// Where E is smooth but its normals turn fast, in the middle plane of a box seen by very many directions,
/// say (a test shows that they draw together as the lattice is refined), the opening across an edge shrinks
/// with the spacing: such a ridge is a shock at a coarse spacing only. At a true shock it does not.
///
/// @throws CoreError kBadInput when an option is not finite or out of range.
std::vector<ChordShock> chord_shocks(const Lattice& lattice, const FrameField& field,
                                     const ChordShockOptions& options = {});

/// The squares of the lattice that the shock's edge stands for, |N_a|: area of the sheet per spacing squared.
double squares_of(const ChordShock& shock);

}  // namespace affskel::core
