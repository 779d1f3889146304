#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/chords/chord_shocks.h"
#include "core/lattice/solid_parts.h"

// Edges and squares of the lattice, and which bound which.  Once round a square, the sheet is crossed as
// often one way as the other: a square with a single shock on its four edges lies on the sheet's rim.

namespace affskel::core {

/// A lattice edge (axis: its own) or square (axis: its normal) of a part of the solid, by its lowest point.
struct LatticeElement {
  std::array<std::int64_t, 3> place{};
  std::uint32_t axis = 0;
  std::uint32_t part = 0;
  friend auto operator<=>(const LatticeElement&, const LatticeElement&) = default;
};

inline LatticeElement moved(LatticeElement element, std::size_t axis, std::int64_t steps) {
  element.place[axis] += steps;
  return element;
}

inline LatticeElement edge_of(const ChordShock& shock, const SolidParts& parts) {
  return {{shock.place[0], shock.place[1], shock.place[2]}, shock.axis, parts.of_point(shock.point)};
}

/// The squares round an edge.
inline std::array<LatticeElement, 4> squares_round(const LatticeElement& edge) {
  const std::uint32_t u = (edge.axis + 1) % 3, v = (edge.axis + 2) % 3;
  const LatticeElement across_u{edge.place, u, edge.part}, across_v{edge.place, v, edge.part};
  return {across_u, moved(across_u, v, -1), across_v, moved(across_v, u, -1)};
}

inline std::array<LatticeElement, 4> edges_of(const LatticeElement& square) {
  const std::uint32_t u = (square.axis + 1) % 3, v = (square.axis + 2) % 3;
  const LatticeElement along_u{square.place, u, square.part}, along_v{square.place, v, square.part};
  return {along_u, moved(along_u, v, 1), along_v, moved(along_v, u, 1)};
}

/// A shock is added on an edge only where at least this many of the four squares round it lie on the rim, so
/// that the rim becomes shorter.
inline constexpr std::size_t kMinRimSquares = 3;

/// A square on the rim and the index of its only shock.
using RimSquare = std::pair<LatticeElement, std::uint32_t>;

/// The squares on the rim of a sheet made of the chosen shocks, ascending.
/// @param chosen indices of shocks, each edge once.
std::vector<RimSquare> rim_squares(const SolidParts& parts, std::span<const ChordShock> shocks,
                                   std::span<const std::uint32_t> chosen);

}  // namespace affskel::core
