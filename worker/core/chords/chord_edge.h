#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/base/vec3.h"
#include "core/chords/chord_shocks.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// Whether the line stays in the solid from the end of a run to the start of the next one: it has
/// neighbouring points, and the surface between them lies within the solid, where this passes through itself.
/// A line meets a triangle once, so that what it entered by and what it leaves by tell one passage from
/// another.
inline bool continues_in(const LatticeRun& run, const LatticeRun& next, std::size_t axis) {
  std::array<std::uint32_t, 3> behind = run.start;
  behind[axis] += run.length;
  return next.start == behind && next.low == run.low && next.high == run.high;
}

/// Calls `visit(stretch)` for every stretch of a lattice line in the solid: a run, or several that go on from
/// one to the next, as one LatticeRun.  Inside, the surface is no bound for E: where a fold covers a place
/// twice its volume counts twice, and E is about as continuous as elsewhere.  Noise folds a fine mesh all
/// over.
template <class Visit>
void for_each_stretch(const AxisRuns& along, std::size_t axis, Visit visit) {
  for (auto run = along.runs.begin(); run != along.runs.end();) {
    LatticeRun stretch = *run;
    while (++run != along.runs.end() && continues_in(stretch, *run, axis)) stretch.length += run->length;
    visit(stretch);
  }
}

/// Calls `visit(x, y, axis, place)` for every lattice edge between neighbouring sample points of one stretch:
/// ranks of its lower and upper end, its axis (std::uint8_t) and the lattice indices of x.  Between two
/// stretches the line leaves the solid, and across its surface E says nothing.
template <class Visit>
void for_each_edge(const Lattice& lattice, Visit visit) {
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    const AxisRuns& along = lattice.axis[axis];
    for_each_stretch(along, axis, [&](const LatticeRun& run) {
      std::array<std::uint32_t, 3> place = run.start;
      for (std::uint32_t n = run.first; n + 1 < run.first + run.length; ++n, ++place[axis]) {
        const std::uint32_t x = along.order.empty() ? n : along.order[n];
        const std::uint32_t y = along.order.empty() ? n + 1 : along.order[n + 1];
        visit(x, y, axis, place);
      }
    });
  }
}

/// The ends of one such edge, ranks of the lower and the upper, by its lower end's lattice indices; nothing
/// where for_each_edge visits none.  O(log runs).
std::optional<std::array<std::uint32_t, 2>> ends_of_edge(const Lattice& lattice, std::uint8_t axis,
                                                         const std::array<std::uint32_t, 3>& place);

/// The order of lists of shocks: by (point, axis).
inline bool by_edge(const ChordShock& a, const ChordShock& b) {
  return a.point != b.point ? a.point < b.point : a.axis < b.axis;
}

/// What the tangents of E at the ends of a lattice edge say about a shock on it, whatever that is worth: r, o
/// and t are as they come, r negative and t anywhere (or not finite) where there is none.  `position` and
/// `erosion` are left at 0; see clamp_to_edge().
/// @param x, y ranks of the edge's lower and upper end, both with an optimal direction.
/// @param place lattice indices of x.
ChordShock tangents_on_edge(const FrameField& field, std::uint32_t x, std::uint32_t y, std::uint8_t axis,
                            const std::array<std::uint32_t, 3>& place);

/// Moves the shock to the nearest place on its edge, to the middle when the tangents do not cross, and sets
/// `position` and `erosion`.
void clamp_to_edge(const FrameField& field, ChordShock& shock);

/// The opening o = (1 - a.b / (|a| |b|)) / 2 of two normals of any length, 0 .. 1; NaN when one is zero.
double opening_of(const Vec3& a, const Vec3& b);

}  // namespace affskel::core
