#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "core/base/split_mix64.h"
#include "core/base/unit.h"
#include "core/base/vec3.h"
#include "core/lattice/lattice.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// In [0, 1).
inline double draw_share(SplitMix64& random) {
  return 0.5 * (1 + random.symmetric());
}

/// In the cube [-1, 1)^3.
inline Vec3 draw_vector(SplitMix64& random) {
  const double x = random.symmetric(), y = random.symmetric(), z = random.symmetric();
  return {x, y, z};
}

inline Vec3 draw_direction(SplitMix64& random) {
  return unit(draw_vector(random));
}

inline Lattice lattice_of_points(const Solid& solid, std::uint64_t points) {
  LatticeOptions options;
  options.target_points = points;
  return make_lattice(solid, options);
}

/// All sample points, in scaled coordinates.
inline std::vector<Vec3> places_of(const Lattice& lattice) {
  std::vector<std::uint32_t> all(lattice.points);
  std::iota(all.begin(), all.end(), 0U);
  std::vector<Vec3> places;
  for (const auto& [i, j, k] : lattice_places(lattice, all))
    places.push_back(grid_place(lattice.grid, i, j, k));
  return places;
}

}  // namespace affskel::core
