#include "core/quality/similarity.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/spatial/point_index.h"

namespace affskel::core {
namespace {

// The power of two that brings the largest coordinate near 2^500: squared differences then cannot overflow,
// and only differences below 2^-1000 of it have squares that underflow.
int lift_of(std::span<const Vec3> a, std::span<const Vec3> b) {
  constexpr int kTop = 500;
  double largest = 0;
  for (const std::span<const Vec3> set : {a, b}) {
    for (const Vec3& p : set) largest = std::max(largest, largest_component(p));
  }
  return largest > 0 ? kTop - std::ilogb(largest) : 0;
}

Vec3 lifted(const Vec3& p, int exponent) {
  return {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
}

std::vector<Vec3> lifted(std::span<const Vec3> points, int exponent) {
  std::vector<Vec3> up;
  up.reserve(points.size());
  for (const Vec3& p : points) up.push_back(lifted(p, exponent));
  return up;
}

}  // namespace

DistanceCurve::DistanceCurve(std::span<const Vec3> from, std::span<const Vec3> to) {
  if (from.empty() || to.empty()) {
    refuse("a set without points is near nothing");
  }
  const int exponent = lift_of(from, to);
  const PointIndex index(lifted(to, exponent));
  distances_.reserve(from.size());
  for (const Vec3& p : from) distances_.push_back(std::ldexp(index.nearest(lifted(p, exponent)), -exponent));
  std::sort(distances_.begin(), distances_.end());
}

double DistanceCurve::share_within(double radius) const {
  const auto beyond = std::upper_bound(distances_.begin(), distances_.end(), radius);
  return static_cast<double>(beyond - distances_.begin()) / static_cast<double>(distances_.size());
}

double DistanceCurve::area_under(double radius) const {
  double sum = 0;  // every point counts from its distance on
  for (const double d : distances_) sum += std::max(0.0, 1 - d / radius);
  return sum / static_cast<double>(distances_.size());
}

double DistanceCurve::area_under_squared(double radius) const {
  double sum = 0;
  for (const double d : distances_) sum += std::max(0.0, 1 - (d / radius) * (d / radius));
  return sum / static_cast<double>(distances_.size());
}

Similarity similarity(std::span<const Vec3> a, std::span<const Vec3> b) {
  return {DistanceCurve(a, b), DistanceCurve(b, a)};
}

}  // namespace affskel::core
