#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/mesh.h"
#include "core/mesh/polylines.h"

namespace affskel::core {

/// Lines through limbs, drawn from a place outwards, in steps.
struct DrawnLines {
  std::vector<Vec3> places;
  std::vector<double> ball;
  std::vector<Segment> segments;

  std::uint32_t add(const Vec3& at, double thick) {
    places.push_back(at);
    ball.push_back(thick);
    return static_cast<std::uint32_t>(places.size() - 1);
  }
  void join(std::uint32_t a, std::uint32_t b) { segments.push_back({std::min(a, b), std::max(a, b)}); }
  /// @return the last vertex.
  std::uint32_t go(std::uint32_t from, const Vec3& step, int steps, double thick) {
    for (int n = 0; n < steps; ++n) {
      const std::uint32_t to = add(places[from] + step, thick);
      join(from, to);
      from = to;
    }
    return from;
  }
  std::vector<std::vector<std::uint32_t>> lines() const { return polylines(places.size(), segments); }
};

}  // namespace affskel::core
