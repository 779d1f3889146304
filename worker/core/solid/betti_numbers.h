#pragma once

#include <cstdint>

#include "core/solid/solid.h"

namespace affskel::core {

/// Betti numbers of a compact set in space: what is connected, what goes through, what is enclosed.
struct BettiNumbers {
  std::uint64_t components = 0;  ///< b0
  std::uint64_t holes = 0;       ///< b1: independent loops that cannot be drawn together (tunnels)
  std::uint64_t cavities = 0;    ///< b2: enclosed voids

  bool operator==(const BettiNumbers&) const = default;
};

/// Those of a solid, from the closed surfaces that bound it: b0 = its connected solids, b1 = the sum of the
/// genera of all surfaces, those of cavities included, b2 = its cavities.  (For a compact V in space with
/// boundary S, b1(V) is half of b1(S), which is twice the sum of the genera.)
inline BettiNumbers betti_numbers(const Solid& solid) {
  BettiNumbers numbers;
  numbers.components = solid.solid_volume.size();
  for (const Shell& shell : solid.shells) {
    numbers.holes += static_cast<std::uint64_t>(shell.genus);
    numbers.cavities += shell.cavity;
  }
  return numbers;
}

}  // namespace affskel::core
