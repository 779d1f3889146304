#pragma once

#include <cstdint>
#include <span>

#include "core/lattice/lattice.h"

namespace affskel::core {

/// Calls `visit(i, j, k, rank)` for every sample point of runs along the last axis, in lattice order.
template <class Visit>
void for_each_point(std::span<const LatticeRun> runs, Visit visit) {
  for (const LatticeRun& run : runs) {
    for (std::uint32_t n = 0; n < run.length; ++n) {
      visit(static_cast<std::int32_t>(run.start[0]), static_cast<std::int32_t>(run.start[1]),
            static_cast<std::int32_t>(run.start[2] + n), run.first + n);
    }
  }
}

/// The same for all sample points of a lattice.
template <class Visit>
void for_each_point(const Lattice& lattice, Visit visit) {
  for_each_point(std::span<const LatticeRun>(lattice.axis[2].runs), visit);
}

}  // namespace affskel::core
