#include "core/solid/solid_windings.h"

#include <cstdint>
#include <numbers>

#include "core/base/plain_math.h"
#include "core/solid/surface_loops.h"

namespace affskel::core {
namespace {

// The solid angle of a triangle of directions, with a sign (van Oosterom and Strackee 1983).
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double p = norm(a), q = norm(b), r = norm(c);
  const double volume = dot(a, cross(b, c));
  const double base = p * q * r + dot(a, b) * r + dot(b, c) * p + dot(c, a) * q;
  const double half = volume < 0 ? -plain_angle(-volume, base) : plain_angle(volume, base);
  return 2 * half;
}

// The directions from one straight way to another fill a parallelogram.
double linked(const Vec3& from, const Vec3& to, const Vec3& begin, const Vec3& end) {
  const Vec3 a = begin - from, b = begin - to, c = end - to, d = end - from;
  return (solid_angle(a, b, c) + solid_angle(a, c, d)) / (4 * std::numbers::pi);
}

}  // namespace

SolidWindings::SolidWindings(const Mesh& boundary) {
  for (const std::vector<std::uint32_t>& loop : surface_loops(boundary)) {
    std::vector<Vec3>& places = loops_.emplace_back();
    for (const std::uint32_t v : loop) places.push_back(boundary.points[v]);
  }
}

std::vector<double> SolidWindings::along(const Vec3& from, const Vec3& to) const {
  std::vector<double> result;
  result.reserve(loops_.size());
  for (const std::vector<Vec3>& loop : loops_) {
    double sum = 0;
    for (std::size_t n = 0; n < loop.size(); ++n)
      sum += linked(from, to, loop[n], loop[(n + 1) % loop.size()]);
    result.push_back(sum);
  }
  return result;
}

}  // namespace affskel::core
