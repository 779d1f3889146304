// Once round a lattice square, the sheet is crossed as often one way as the other.  So a square with one
// shock on its edges lies on the sheet's rim.  Where three or four of the squares round an edge do, the sheet
// passes between the edge's ends, and their tangents merely fail to say where.
#include "core/chords/chord_pinholes.h"

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/chords/chord_edge.h"

namespace affskel::core {
namespace {

// A shock is added on an edge only where at least this many of the four squares round it lie on the rim, so
// that the rim becomes shorter.
constexpr std::size_t kMinRimSquares = 3;

// A lattice edge (axis: its own) or square (axis: its normal) of a part of the solid, by its lowest point.
struct LatticeElement {
  std::array<std::int64_t, 3> place{};
  std::uint32_t axis = 0;
  std::uint32_t part = 0;
  friend auto operator<=>(const LatticeElement&, const LatticeElement&) = default;
};

LatticeElement moved(LatticeElement element, std::size_t axis, std::int64_t steps) {
  element.place[axis] += steps;
  return element;
}

LatticeElement edge_of(const ChordShock& shock, const SolidParts& parts) {
  return {{shock.place[0], shock.place[1], shock.place[2]}, shock.axis, parts.of_point(shock.point)};
}

std::array<LatticeElement, 4> squares_round(const LatticeElement& edge) {
  const std::uint32_t u = (edge.axis + 1) % 3, v = (edge.axis + 2) % 3;
  const LatticeElement across_u{edge.place, u, edge.part}, across_v{edge.place, v, edge.part};
  return {across_u, moved(across_u, v, -1), across_v, moved(across_v, u, -1)};
}

std::array<LatticeElement, 4> edges_of(const LatticeElement& square) {
  const std::uint32_t u = (square.axis + 1) % 3, v = (square.axis + 2) % 3;
  const LatticeElement along_u{square.place, u, square.part}, along_v{square.place, v, square.part};
  return {along_u, moved(along_u, v, 1), along_v, moved(along_v, u, 1)};
}

// A square on the rim, and its only shock.
using RimSquare = std::pair<LatticeElement, std::uint32_t>;

// Those of a sheet made of the shocks, ascending.
std::vector<RimSquare> rim_squares(const SolidParts& parts, std::span<const ChordShock> shocks) {
  std::vector<RimSquare> used;
  used.reserve(4 * shocks.size());
  for (std::uint32_t s = 0; s < shocks.size(); ++s)
    for (const LatticeElement& square : squares_round(edge_of(shocks[s], parts)))
      used.emplace_back(square, s);
  std::sort(used.begin(), used.end());
  std::vector<RimSquare> rim;
  for (std::size_t first = 0, last; first < used.size(); first = last) {
    for (last = first + 1; last < used.size() && used[last].first == used[first].first;) ++last;
    if (last - first == 1) rim.push_back(used[first]);
  }
  return rim;
}

// The edges without a shock of whose squares most lie on the rim; ascending.
std::vector<LatticeElement> pinholes(const SolidParts& parts, std::span<const ChordShock> shocks) {
  std::vector<LatticeElement> asked;  // once by each square on the rim
  for (const auto& [square, s] : rim_squares(parts, shocks)) {
    const LatticeElement only = edge_of(shocks[s], parts);
    for (const LatticeElement& edge : edges_of(square)) {
      if (edge != only) asked.push_back(edge);
    }
  }
  std::sort(asked.begin(), asked.end());
  std::vector<LatticeElement> result;
  for (std::size_t first = 0, last; first < asked.size(); first = last) {
    for (last = first + 1; last < asked.size() && asked[last] == asked[first];) ++last;
    if (last - first >= kMinRimSquares) result.push_back(asked[first]);
  }
  return result;
}

}  // namespace

std::vector<ChordShock> pinhole_shocks(const Lattice& lattice, const SolidParts& parts,
                                       const FrameField& field, std::span<const ChordShock> shocks) {
  std::vector<ChordShock> result;
  for (const LatticeElement& hole : pinholes(parts, shocks)) {
    if (std::min({hole.place[0], hole.place[1], hole.place[2]}) < 0) continue;
    std::array<std::uint32_t, 3> place{};
    for (std::size_t k = 0; k < 3; ++k) place[k] = static_cast<std::uint32_t>(hole.place[k]);
    const auto axis = static_cast<std::uint8_t>(hole.axis);
    const auto ends = ends_of_edge(lattice, axis, place);
    if (!ends || parts.of_point(ends->front()) != hole.part) continue;
    const auto [x, y] = *ends;
    if (field.direction[x] == field.direction[y]) continue;
    ChordShock shock = tangents_on_edge(field, x, y, axis, place);
    if (!(shock.strength > 0)) shock.strength = 0;
    clamp_to_edge(field, shock);
    shock.turn = shock.opening;
    result.push_back(shock);
  }
  std::sort(result.begin(), result.end(), by_edge);
  return result;
}

}  // namespace affskel::core
