#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/lattice/lattice.h"

// The lattice edges within the solid: pairs of neighbouring sample points with no way out between them.

namespace affskel::core {

/// A lattice edge, from a sample point to the next one along an axis.
struct LatticeEdge {
  std::uint32_t point = 0;               ///< rank of its lower end
  std::uint8_t axis = 0;                 ///< 0 .. 2
  std::array<std::uint32_t, 3> place{};  ///< lattice indices of its lower end
};

/// Whether the line stays in the solid from the end of a run to the start of the next one on it: the runs
/// follow each other without a place between them, and the surface there lies inside the solid, where it
/// passes through itself.  Both runs are bounded by the same two triangles then, since a line meets a
/// triangle once.
inline bool continues_in(const LatticeRun& run, const LatticeRun& next, std::size_t axis) {
  std::array<std::uint32_t, 3> behind = run.start;
  behind[axis] += run.length;
  return next.start == behind && next.low == run.low && next.high == run.high;
}

/// Calls `visit(stretch)` for every stretch of a lattice line, as one LatticeRun: a run, or several that
/// continue each other.  Surface inside a stretch is no bound for E: where a fold covers a place twice its
/// volume counts twice, and E is about as continuous as elsewhere.  Noise folds a fine mesh everywhere.
template <class Visit>
void for_each_stretch(const AxisRuns& along, std::size_t axis, Visit visit) {
  for (auto run = along.runs.begin(); run != along.runs.end();) {
    LatticeRun stretch = *run;
    while (++run != along.runs.end() && continues_in(stretch, *run, axis)) stretch.length += run->length;
    visit(stretch);
  }
}

/// Calls `visit(x, y, axis, place)` for every lattice edge between neighbouring sample points of one stretch:
/// ranks of its lower and upper end, its axis (std::uint8_t) and the lattice indices of x.  Edges between
/// stretches leave the solid and are left out.
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

}  // namespace affskel::core
