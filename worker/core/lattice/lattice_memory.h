#pragma once

#include <cstdint>
#include <string>

#include "core/base/error.h"

namespace affskel::core {

/// A lattice takes more memory than there is: kLimit, but on another machine it may fit.
class LatticeMemoryError : public CoreError {
 public:
  LatticeMemoryError(const std::string& message, std::uint64_t bytes)
      : CoreError(Code::kLimit, message), bytes_(bytes) {}
  /// What the lattice takes, as lattice_memory() estimates it.
  std::uint64_t bytes() const { return bytes_; }

 private:
  std::uint64_t bytes_;
};

/// A lattice before most of its memory is taken.
struct LatticeSize {
  double points = 0;   ///< sample points
  double lines = 0;    ///< lattice lines along axis 2
  double spacing = 0;  ///< mesh units
};

/// What laying the lattice and keeping it takes at its peak, bytes: a lower estimate, within about 10 % of
/// what was measured for bodies, spheres and boxes of 1e7 points and more.
/// @param point_bytes what the caller is going to take for every sample point beside the lattice.
double lattice_memory(const LatticeSize& size, double point_bytes);

/// @param budget bytes; 0 = no bound.
/// @throws LatticeMemoryError when the lattice takes more than the budget, naming its points, what they take,
///   the budget, and a spacing and a number of points that would fit.
void require_lattice_memory(const LatticeSize& size, double point_bytes, std::uint64_t budget);

}  // namespace affskel::core
