// Once round a lattice square, the sheet is crossed as often one way as the other.  So a square with one
// shock on its edges lies on the sheet's rim.  Where three or four of the squares round an edge do, the sheet
// passes between the edge's ends, and their tangents merely fail to say where.
#include "core/chords/chord_pinholes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

#include "core/chords/chord_edge.h"
#include "core/chords/chord_squares.h"

namespace affskel::core {
namespace {

// The edges without a shock of whose squares most lie on the rim; ascending.
std::vector<LatticeElement> pinholes(const SolidParts& parts, std::span<const ChordShock> shocks) {
  std::vector<std::uint32_t> all(shocks.size());
  std::iota(all.begin(), all.end(), 0U);
  std::vector<LatticeElement> asked;  // once by each square on the rim
  for (const auto& [square, s] : rim_squares(parts, shocks, all)) {
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
