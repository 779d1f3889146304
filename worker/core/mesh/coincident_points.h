#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"

namespace affskel::core {

/// Per point the first point at the same place (0 and -0 are the same place), its own index if there is none
/// before it.  No coordinate may be NaN.  O(n log n).
std::vector<std::uint32_t> first_coincident_point(std::span<const Vec3> points);

}  // namespace affskel::core
