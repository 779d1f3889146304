#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"
#include "core/chords/chord_constants.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

// Notation.  x and y are the ends of a lattice edge, delta = y - x, g_x and g_y the gradients of E there, in
// the coordinates of the lattice's frame (see frame_field.h).  The tangents of E at x and y cross at
// x + t delta,  t = (E_y - E_x - g_y.delta) / s,  with the kink  s = (g_x - g_y).delta.

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
  double turn = 0;  ///< opening over a band across the sheet, see measure_turns(); until then o
  Vec3 gradient_low, gradient_high;  ///< g_x and g_y; the sheet's normal is along their difference
  std::uint32_t direction_low = 0, direction_high = 0;  ///< indices of the two optimal directions
  /// Over all directions: its planes lead to one piece, so that it is no shock in the strict sense; see
  /// place_at_equal_chords().
  bool turns = false;
};

/// The shocks of E on all lattice edges between neighbouring sample points of one stretch (Zografos 2003,
/// section 3.4: points with two equal optimal chords), by (point, axis).  O(sample points).
///
/// E, t, s and r are affinely invariant.  The opening is so only where the frame's metric goes along with the
/// map, as in the frame `affine`.
/// @param field of this lattice.
std::vector<ChordShock> chord_shocks(const Lattice& lattice, const FrameField& field,
                                     const ChordConstants& constants = {});

/// The area of the sheet that the shock's edge stands for, in lattice squares: |N_a|.
double squares_of(const ChordShock& shock);

}  // namespace affskel::core
