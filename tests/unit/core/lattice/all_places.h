#pragma once

#include <cstdint>
#include <vector>

#include "core/lattice/lattice.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// Where all sample points are, in mesh units, in lattice order.
inline std::vector<Vec3> all_places(const Solid& solid, const Lattice& lattice) {
  const SamplePlaces places(solid, lattice);
  std::vector<Vec3> all;
  for (const LatticeRun& run : lattice.axis[2].runs) {
    for (std::uint32_t n = 0; n < run.length; ++n) {
      all.push_back(places.at(run.start[0], run.start[1], run.start[2] + n));
    }
  }
  return all;
}

}  // namespace affskel::core
