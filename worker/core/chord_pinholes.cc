#include "core/chord_pinholes.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/chord_edge.h"

namespace affskel::core {
namespace {

using Place = std::array<std::int64_t, 3>;

// A lattice edge (axis: its own) or square (axis: its normal) of a part, by its lowest point.
struct Element {
  Place place;
  std::uint32_t axis;
  std::uint32_t part;
  friend auto operator<=>(const Element&, const Element&) = default;
};

Element moved(Element element, std::size_t axis, std::int64_t steps) {
  element.place[axis] += steps;
  return element;
}

Element edge_of(const ChordShock& shock, const SolidParts& parts) {
  return {{shock.place[0], shock.place[1], shock.place[2]}, shock.axis, parts.of_point(shock.point)};
}

std::array<Element, 4> squares_round(const Element& edge) {
  const std::uint32_t u = (edge.axis + 1) % 3, v = (edge.axis + 2) % 3;
  const Element across_u{edge.place, u, edge.part}, across_v{edge.place, v, edge.part};
  return {across_u, moved(across_u, v, -1), across_v, moved(across_v, u, -1)};
}

std::array<Element, 4> edges_of(const Element& square) {
  const std::uint32_t u = (square.axis + 1) % 3, v = (square.axis + 2) % 3;
  const Element along_u{square.place, u, square.part}, along_v{square.place, v, square.part};
  return {along_u, moved(along_u, v, 1), along_v, moved(along_v, u, 1)};
}

struct SquareOfShock {
  Element square, edge;
  friend auto operator<=>(const SquareOfShock&, const SquareOfShock&) = default;
};

// The edges without a shock that are alone in lacking one, in all their four squares; ascending.
std::vector<Element> pinholes(const SolidParts& parts, std::span<const ChordShock> shocks) {
  std::vector<SquareOfShock> used;
  used.reserve(4 * shocks.size());
  for (const ChordShock& shock : shocks) {
    const Element edge = edge_of(shock, parts);
    for (const Element& square : squares_round(edge)) used.push_back({square, edge});
  }
  std::sort(used.begin(), used.end());
  std::vector<Element> asked;  // once by each square with a single shock
  for (std::size_t first = 0, last; first < used.size(); first = last) {
    for (last = first + 1; last < used.size() && used[last].square == used[first].square;) ++last;
    if (last - first > 1) continue;
    for (const Element& edge : edges_of(used[first].square)) {
      if (edge != used[first].edge) asked.push_back(edge);
    }
  }
  std::sort(asked.begin(), asked.end());
  std::vector<Element> result;
  for (std::size_t first = 0, last; first < asked.size(); first = last) {
    for (last = first + 1; last < asked.size() && asked[last] == asked[first];) ++last;
    if (last - first == 4) result.push_back(asked[first]);
  }
  return result;
}

}  // namespace

std::vector<ChordShock> pinhole_shocks(const Lattice& lattice, const SolidParts& parts,
                                       const FrameField& field, std::span<const ChordShock> shocks) {
  const std::vector<Element> holes = pinholes(parts, shocks);
  std::vector<ChordShock> result;
  if (holes.empty()) return result;
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    const AxisRuns& along = lattice.axis[axis];
    for (const LatticeRun& run : along.runs) {
      std::array<std::uint32_t, 3> place = run.start;
      for (std::uint32_t n = run.first; n + 1 < run.first + run.length; ++n, ++place[axis]) {
        const std::uint32_t x = along.order.empty() ? n : along.order[n];
        const std::uint32_t y = along.order.empty() ? n + 1 : along.order[n + 1];
        if (field.direction[x] == field.direction[y]) continue;
        const Element edge{{place[0], place[1], place[2]}, axis, parts.of_point(x)};
        if (!std::binary_search(holes.begin(), holes.end(), edge)) continue;
        ChordShock shock = tangents_on_edge(field, x, y, axis, place);
        if (!(shock.strength > 0)) shock.strength = 0;
        settle_on_edge(field, shock);
        shock.turn = shock.opening;
        result.push_back(shock);
      }
    }
  }
  std::sort(result.begin(), result.end(), [](const ChordShock& a, const ChordShock& b) {
    return a.point != b.point ? a.point < b.point : a.axis < b.axis;
  });
  return result;
}

}  // namespace affskel::core
