#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/matrix3.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Axis-parallel box, closed; by itself the empty one, which holds nothing.
struct Box {
  std::array<double, 3> low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  bool meets(const Box& other) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (low[k] > other.high[k] || other.low[k] > high[k]) return false;
    }
    return true;
  }
  void include(const Box& other) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], other.low[k]);
      high[k] = std::max(high[k], other.high[k]);
    }
  }
  void include(const Vec3& p) { include(Box{{p.x, p.y, p.z}, {p.x, p.y, p.z}}); }
  /// Of a place from the box, in which it is 0.
  double squared_distance(const Vec3& place) const {
    const auto outside = [](double x, double a, double b) { return x < a ? a - x : x > b ? x - b : 0.0; };
    const Vec3 way = {outside(place.x, low[0], high[0]), outside(place.y, low[1], high[1]),
                      outside(place.z, low[2], high[2])};
    return dot(way, way);
  }

  Vec3 lowest() const { return {low[0], low[1], low[2]}; }
  Vec3 highest() const { return {high[0], high[1], high[2]}; }
  Vec3 sides() const { return highest() - lowest(); }
  Vec3 middle() const { return 0.5 * (lowest() + highest()); }
  double diagonal() const { return norm(sides()); }
  /// The axis of the longest side, the first of equal ones.
  std::size_t longest_axis() const;
  double longest_side() const { return high[longest_axis()] - low[longest_axis()]; }
};

/// Tightest box round points.
Box box_of(std::span<const Vec3> points);

/// Tightest box along the axes, in coordinates along them.
Box box_of(std::span<const Vec3> points, const Matrix3& axes);
/// Tightest box round a triangle.
Box box_of(const Mesh& mesh, const Triangle& triangle);

/// Tightest box round all triangles.
Box box_of(const Mesh& mesh);

/// The boxes of all triangles of a mesh.
std::vector<Box> boxes_of(const Mesh& mesh);

}  // namespace affskel::core
