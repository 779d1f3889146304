// Notation: README.md in worker/core.  The same shock has r near 1 on edges across the sheet and a small r on
// those along it.  What tells shocks from the facets of a level surface is therefore not r but the opening,
// and the candidates are many: turns and pruning choose among them.
//
// Where E is smooth but its normals turn fast (the middle plane of a box seen by thousands of directions),
// the opening across an edge shrinks with the spacing, and so does the largest kink's share of the turn: such
// a ridge is a shock at coarse spacings only.  At a true shock both stay.
#include "core/chords/chord_shocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/unit.h"
#include "core/chords/chord_edge.h"
#include "core/erosion/field.h"

namespace affskel::core {
namespace {

class ShockFinder {
 public:
  ShockFinder(const Lattice& lattice, const FrameField& field, const ChordConstants& constants)
      : lattice_(lattice), field_(field), constants_(constants) {}

  std::vector<ChordShock> run() {
    for_each_edge(lattice_, [&](std::uint32_t x, std::uint32_t y, std::uint8_t axis, const auto& place) {
      if (const std::optional<ChordShock> shock = between(x, y, axis, place)) shocks_.push_back(*shock);
    });
    std::sort(shocks_.begin(), shocks_.end(), by_edge);
    return std::move(shocks_);
  }

 private:
  std::optional<ChordShock> between(std::uint32_t x, std::uint32_t y, std::uint8_t axis,
                                    const std::array<std::uint32_t, 3>& place) const {
    const std::uint32_t none = FieldValue::kNoDirection;
    if (field_.direction[x] == field_.direction[y] || field_.direction[x] == none ||
        field_.direction[y] == none) {
      return {};
    }
    ChordShock shock = tangents_on_edge(field_, x, y, axis, place);
    if (!(shock.strength > 0)) return {};
    if (!(shock.strength >= constants_.min_strength && shock.opening >= constants_.min_opening)) return {};
    if (!(shock.t >= -constants_.slack && shock.t <= 1 + constants_.slack)) return {};
    clamp_to_edge(field_, shock);
    shock.turn = shock.opening;
    return shock;
  }

  const Lattice& lattice_;
  const FrameField& field_;
  const ChordConstants& constants_;
  std::vector<ChordShock> shocks_;
};

}  // namespace

std::vector<ChordShock> chord_shocks(const Lattice& lattice, const FrameField& field,
                                     const ChordConstants& constants) {
  return ShockFinder(lattice, field, constants).run();
}

double squares_of(const ChordShock& shock) {
  const Vec3 normal = scaled_to_unit(shock.gradient_low - shock.gradient_high);
  return std::abs(normal[shock.axis]) / norm(normal);
}

}  // namespace affskel::core
