#include "core/chords/chord_sheet.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/base/matrix3.h"
#include "core/base/unit.h"
#include "core/chords/chord_edge.h"
#include "core/chords/chord_pinholes.h"
#include "core/chords/chord_turns.h"
#include "core/contour/dual_contour.h"
#include "core/lattice/solid_parts.h"

namespace affskel::core {
namespace {

// What a vertex tells of the shocks in its cell.
class VertexValues {
 public:
  VertexValues(const Lattice& lattice, const std::vector<ChordShock>& shocks)
      : shocks_(shocks), to_mesh_(inverse_transposed(frame_matrix(lattice))) {}

  SheetVertex at(const Vec3& position, std::span<const std::uint32_t> members) const {
    const ChordShock& first = shocks_[members[0]];
    const Vec3 reference = first.gradient_low - first.gradient_high;
    const double share = 1 / static_cast<double>(members.size());
    SheetVertex v;
    v.turns = std::ranges::all_of(members, [&](std::uint32_t s) { return shocks_[s].turns; });
    for (std::uint32_t s : members) {
      const ChordShock& shock = shocks_[s];
      const bool turned = dot(shock.gradient_low - shock.gradient_high, reference) < 0;
      // Along the sheet both branches change equally, so their mean gradient leads from the shock to the
      // vertex.
      const Vec3 slope = 0.5 * (shock.gradient_low + shock.gradient_high);
      v.erosion += share * (shock.erosion + dot(slope, position - shock.position));
      v.strength += share * shock.strength;
      v.area += share * 0.5 *
                (section_area(to_mesh_, shock.gradient_low) + section_area(to_mesh_, shock.gradient_high));
      v.normal_a = v.normal_a + unit(turned ? shock.gradient_high : shock.gradient_low);
      v.normal_b = v.normal_b + unit(turned ? shock.gradient_low : shock.gradient_high);
    }
    v.erosion = std::max(v.erosion, 0.0);
    v.strength = std::min(v.strength, 1.0);  // a mean may round up
    v.normal_a = unit(v.normal_a);
    v.normal_b = unit(v.normal_b);
    return v;
  }

 private:
  const std::vector<ChordShock>& shocks_;
  Matrix3 to_mesh_;  // F^-T
};

void contour(const Lattice& lattice, const SolidParts& parts, const ChordSheetOptions& options,
             ChordSheet& sheet) {
  std::vector<SheetCrossing> crossings;
  crossings.reserve(sheet.shocks.size());
  for (const ChordShock& shock : sheet.shocks) {
    crossings.push_back({shock.position, unit(shock.gradient_low - shock.gradient_high)});
  }
  const VertexValues values(lattice, sheet.shocks);
  static_cast<SheetMesh&>(sheet) = dual_contour(
      lattice, parts, cells_of(lattice, parts, sheet.shocks), crossings,
      [&](const Vec3& position, std::span<const std::uint32_t> members) {
        return values.at(position, members);
      },
      options.context);
}

void close_pinholes(const Lattice& lattice, const SolidParts& parts, const FrameField& field,
                    std::vector<ChordShock>& shocks) {
  // Closing one may leave another: each round makes the rim shorter.
  for (;;) {
    const std::vector<ChordShock> missing = pinhole_shocks(lattice, parts, field, shocks);
    if (missing.empty()) return;
    const auto old_end = static_cast<std::ptrdiff_t>(shocks.size());
    shocks.insert(shocks.end(), missing.begin(), missing.end());
    std::inplace_merge(shocks.begin(), shocks.begin() + old_end, shocks.end(), by_edge);
  }
}

// In a frame that stretches a flat solid, no turn may be as wide as that of a strong shock.
double strong_turn(const std::vector<ChordShock>& shocks, const ChordConstants& constants) {
  double max_turn = 0;
  for (const ChordShock& shock : shocks) max_turn = std::max(max_turn, shock.turn);
  return std::min(constants.strong_turn,
                  std::max(constants.min_strong_turn, constants.strong_share * max_turn));
}

}  // namespace

ChordSheet chord_sheet(const Solid& solid, const Lattice& lattice, const FrameField& field,
                       const ChordSheetOptions& options) {
  const SolidParts parts(solid, lattice);
  std::vector<ChordShock> candidates = chord_shocks(lattice, field);
  throw_if_stopped(options.context);
  ChordConstants constants = options.refined == nullptr ? ChordConstants() : constants_of_infimum();
  measure_turns(lattice, parts, field, candidates, options.context, constants);
  throw_if_stopped(options.context);
  constants.strong_turn = strong_turn(candidates, constants);
  ChordSheet sheet;
  static_cast<SignificantShocks&>(sheet) =
      significant_shocks(lattice, parts, candidates, options.significance, constants);
  sheet.strong_turn = constants.strong_turn;
  throw_if_stopped(options.context);
  close_pinholes(lattice, parts, field, sheet.shocks);
  if (options.refined != nullptr) {
    place_at_equal_chords(solid, lattice, field, *options.refined, sheet.shocks, options.context);
  }
  contour(lattice, parts, options, sheet);
  return sheet;
}

}  // namespace affskel::core
