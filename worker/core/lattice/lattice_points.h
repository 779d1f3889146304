#pragma once

#include <cstdint>

#include "core/lattice/lattice.h"

namespace affskel::core {

/// Calls `visit(i, j, k, rank)` for every sample point, in lattice order.
template <class Visit>
void for_each_point(const Lattice& lattice, Visit visit) {
  for (const LatticeRun& run : lattice.axis[2].runs) {
    for (std::uint32_t n = 0; n < run.length; ++n) {
      visit(static_cast<std::int32_t>(run.start[0]), static_cast<std::int32_t>(run.start[1]),
            static_cast<std::int32_t>(run.start[2] + n), run.first + n);
    }
  }
}

}  // namespace affskel::core
