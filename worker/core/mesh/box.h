#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/matrix3.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Axis-parallel box, closed; by itself the empty one, which holds nothing.
struct Box {
  Vec3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  bool meets(const Box& other) const {
    return !(low.x > other.high.x || other.low.x > high.x || low.y > other.high.y || other.low.y > high.y ||
             low.z > other.high.z || other.low.z > high.z);
  }
  void include(const Box& other) {
    low = {std::min(low.x, other.low.x), std::min(low.y, other.low.y), std::min(low.z, other.low.z)};
    high = {std::max(high.x, other.high.x), std::max(high.y, other.high.y), std::max(high.z, other.high.z)};
  }
  void include(const Vec3& p) { include(Box{p, p}); }
  /// By so much on every side.
  Box widened(double by) const { return {low - Vec3{by, by, by}, high + Vec3{by, by, by}}; }
  /// Of a place from the box, in which it is 0.
  double squared_distance(const Vec3& place) const {
    const auto outside = [](double x, double a, double b) { return x < a ? a - x : x > b ? x - b : 0.0; };
    const Vec3 way = {outside(place.x, low.x, high.x), outside(place.y, low.y, high.y),
                      outside(place.z, low.z, high.z)};
    return dot(way, way);
  }

  Vec3 sides() const { return high - low; }
  Vec3 middle() const { return 0.5 * (low + high); }
  double diagonal() const { return norm(sides()); }
  /// The axis of the longest side, the first of equal ones.
  std::size_t longest_axis() const;
  double longest_side() const { return sides()[longest_axis()]; }
};

/// Tightest box round points.
Box box_of(std::span<const Vec3> points);

/// Tightest box along the axes, in coordinates along them.
Box box_of(std::span<const Vec3> points, const Matrix3& axes);
/// Tightest box round a triangle.
Box box_of(const Mesh& mesh, const Triangle& triangle);

/// Tightest box round all triangles.
Box box_of(const Mesh& mesh);

/// Length of the diagonal of the tightest axis-parallel box round the points that triangles use (round all
/// points when there are no triangles), mesh units.
double box_diagonal(const Mesh& mesh);

/// The boxes of all triangles of a mesh.
std::vector<Box> boxes_of(const Mesh& mesh);

}  // namespace affskel::core
