#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Axis-parallel box, closed.
struct Box {
  std::array<double, 3> low, high;

  bool meets(const Box& other) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (low[k] > other.high[k] || other.low[k] > high[k]) return false;
    }
    return true;
  }
  void include(const Box& other);
};

/// Tightest box round a triangle.
Box box_of(const Mesh& mesh, const Triangle& triangle);

/// The boxes of all triangles of a mesh.
std::vector<Box> boxes_of(const Mesh& mesh);

}  // namespace affskel::core
