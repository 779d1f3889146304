#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/solid/solid.h"

namespace affskel::core {

/// Shells that lie on each other: pairs (i, j), i < j, with equal corners of equally many triangles, each shell with the
/// first that it is like.  Corners are compared by sums of their hashes, 64 bits.
std::vector<std::pair<std::uint32_t, std::uint32_t>> copied_shells(const Solid& solid);

}  // namespace affskel::core
