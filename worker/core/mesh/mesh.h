#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"

namespace affskel::core {

using Triangle = std::array<std::uint32_t, 3>;

/// A piece of a curve: the indices of its two ends.
using Segment = std::array<std::uint32_t, 2>;

/// The segment between two points, the lower index first.
constexpr Segment ascending(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

/// A triangle soup with shared vertices: plain data, no promise of being closed or manifold.
struct Mesh {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;  ///< indices into points; counter-clockwise seen from outside
};

}  // namespace affskel::core
