#include "core/solid/betti_numbers.h"

namespace affskel::core {

BettiNumbers betti_numbers(const Solid& solid) {
  BettiNumbers numbers;
  numbers.components = solid.solid_volume.size();
  for (const Shell& shell : solid.shells) {
    numbers.holes += static_cast<std::uint64_t>(shell.genus);
    numbers.cavities += shell.cavity;
  }
  return numbers;
}

}  // namespace affskel::core
