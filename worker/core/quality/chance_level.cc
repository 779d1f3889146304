#include "core/quality/chance_level.h"

#include "core/base/split_mix64.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/spatial/point_index.h"

namespace affskel::core {

double chance_level(const Lattice& lattice, const SolidMembership& solid, std::span<const Vec3> skeleton,
                    const ChanceLevelOptions& options) {
  const PointIndex index(skeleton);
  const double radius = options.radius * lattice.spacing;
  SplitMix64 random(options.seed);
  std::uint64_t inside = 0, near = 0;
  auto run = lattice.axis[2].runs.begin();
  for (std::uint64_t draw = 0; draw < options.draws; ++draw) {
    const auto point = static_cast<std::uint32_t>(draw * lattice.points / options.draws);
    while (point - run->first >= run->length) ++run;
    const Vec3 place{run->start[0] + 0.5 * random.symmetric(), run->start[1] + 0.5 * random.symmetric(),
                     run->start[2] + (point - run->first) + 0.5 * random.symmetric()};
    if (!solid.contains(scaled_place(lattice, place))) continue;
    ++inside;
    near += index.nearest(lattice.spacing * place) <= radius;
  }
  return inside == 0 ? 0 : static_cast<double>(near) / static_cast<double>(inside);
}

}  // namespace affskel::core
