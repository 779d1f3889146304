// Notation: README.md in worker/core.  The same shock has r near 1 on edges across the sheet and a small r on
// those along it.  What tells shocks from the facets of a level surface is therefore not r but the opening,
// and the candidates are many: turns and pruning choose among them.
//
// Where E is smooth but its normals turn fast (the middle plane of a box seen by thousands of directions),
// the opening across an edge shrinks with the spacing, and so does the largest kink's share of the turn: such
// a ridge is a shock at coarse spacings only.  At a true shock both stay.
#include "core/chords/chord_shocks.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/unit.h"
#include "core/chords/chord_edge.h"
#include "core/erosion/field.h"

namespace affskel::core {
namespace {

std::optional<ChordShock> shock_between(const FrameField& field, const ChordConstants& constants,
                                        std::uint32_t x, std::uint32_t y, std::uint8_t axis,
                                        const std::array<std::uint32_t, 3>& place) {
  const std::uint32_t none = FieldValue::kNoDirection;
  if (field.direction[x] == field.direction[y] || field.direction[x] == none || field.direction[y] == none)
    return {};
  ChordShock shock = tangents_on_edge(field, x, y, axis, place);
  if (!(shock.strength > 0)) return {};
  if (!(shock.strength >= constants.min_strength && shock.opening >= constants.min_opening)) return {};
  if (!(shock.t >= -constants.slack && shock.t <= 1 + constants.slack)) return {};
  clamp_to_edge(field, shock);
  shock.turn = shock.opening;
  return shock;
}

}  // namespace

std::vector<ChordShock> chord_shocks(const Lattice& lattice, const FrameField& field,
                                     const ChordConstants& constants) {
  std::vector<ChordShock> shocks;
  for_each_edge(lattice, [&](std::uint32_t x, std::uint32_t y, std::uint8_t axis, const auto& place) {
    if (const auto shock = shock_between(field, constants, x, y, axis, place)) shocks.push_back(*shock);
  });
  std::sort(shocks.begin(), shocks.end(), by_edge);
  return shocks;
}

double squares_of(const ChordShock& shock) {
  const Vec3 normal = scaled_to_unit(shock.gradient_low - shock.gradient_high);
  return std::abs(normal[shock.axis]) / norm(normal);
}

}  // namespace affskel::core
