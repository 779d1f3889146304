// With P = sqrt(E / max E): lambda_E = 2 P lambda_P and grad E = 2 P grad P, in units of max E and of the
// spacing, so that s = -lambda_P P / (2 |grad P|^2).
#include "core/ridge/ridge_values.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/require.h"
#include "core/base/symmetric_eigen.h"
#include "core/base/unit.h"
#include "core/ridge/local_depth.h"
#include "core/ridge/ridge_constants.h"

namespace affskel::core {
namespace {

double strength_of(double least, double value, double square) {
  const double turn = -least * value;
  return turn < 2 * kMaxRidgeStrength * square ? 0.5 * turn / square : kMaxRidgeStrength;
}

std::array<float, 3> floats_of(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

PointRidge ridge_at(const PointDerivatives& point, double min_strength) {
  const auto& h = point.hessian;
  double largest = 0, squares = 0;
  for (std::size_t n = 0; n < 6; ++n) {
    const double entry = std::abs(static_cast<double>(h[n]));
    largest = std::max(largest, entry);
    squares += (n == 0 || n == 3 || n == 5 ? 1 : 2) * entry * entry;
  }
  // -lambda_1 is at most the Frobenius norm: most points need no eigenvalues.
  const Vec3 gradient = vector_of(point.gradient);
  const auto is_weak = [&](double least) {
    return strength_of(least, static_cast<double>(point.value), dot(gradient, gradient)) <
           0.25 * min_strength;
  };
  if (largest == 0 || is_weak(-std::sqrt(squares))) return {};
  Matrix3 scaled = hessian_of(point);
  for (Vec3& column : scaled) column = column / largest;
  const SymmetricEigen eigen = symmetric_eigen(scaled);
  if (eigen.values[2] >= 0 || is_weak(eigen.values[2] * largest)) return {};
  return {floats_of(eigen.vectors[2]), floats_of(eigen.vectors[0]),
          static_cast<float>(eigen.values[2] * largest),
          static_cast<float>(eigen.values[1] / eigen.values[2]),
          static_cast<float>(eigen.values[0] / eigen.values[2])};
}

}  // namespace

RidgeValues::RidgeValues(const Lattice& lattice, const FrameField& field,
                         std::span<const PointDerivatives> derivatives, std::span<const float> radius,
                         const DistanceToMesh& surface, const DistanceToMesh* smoothed, double min_strength,
                         unsigned threads)
    : field_(field),
      derivatives_(derivatives),
      radius_(radius),
      surface_(surface),
      smoothed_(smoothed),
      widest_(1.5 + static_cast<double>(*std::max_element(radius.begin(), radius.end()))),
      min_strength_(min_strength),
      to_mesh_(inverse_transposed(frame_matrix(lattice))) {
  require_within(min_strength, 1e-6, kMaxRidgeStrength,
                 "the least strength of a ridge must lie between 1e-6 and 1000");
  const std::size_t points = derivatives.size();
  groups_.resize((points + 31) / 32);
  ridges_.resize((points + kTogether - 1) / kTogether);
  parallel_for(threads, ridges_.size(), [&](std::size_t n) {
    std::vector<PointRidge> found;
    for (std::size_t p = n * kTogether; p < std::min(points, (n + 1) * kTogether); ++p) {
      Group& group = groups_[p / 32];
      if (p % 32 == 0) group.before = static_cast<std::uint32_t>(found.size());
      const PointRidge ridge = ridge_at(derivatives[p], min_strength);
      if (ridge.least >= 0) continue;
      group.has |= 1U << p % 32;
      found.push_back(ridge);
    }
    ridges_[n].assign(found.begin(), found.end());
  });
}

double RidgeValues::least_radius(const SheetVertex& vertex) const {
  return RidgeConstants::min_radius_share * static_cast<double>(derivatives_[vertex.point].depth);
}

bool RidgeValues::is_deep(const SheetVertex& vertex) const {
  const auto radius = static_cast<double>(radius_[vertex.point]);
  const double share =
      smoothed_ == nullptr ? RidgeConstants::min_ball_share : RidgeConstants::noisy_ball_share;
  // No ball in the solid is too large for it: without a search.
  if (is_surely_deep(radius, std::max(least_radius(vertex), share / RidgeConstants::min_ball * widest_)))
    return true;
  return is_deep(vertex, surface_) || (smoothed_ != nullptr && is_deep(vertex, *smoothed_));
}

// Beside a hollow wall, where E is large up to the surface, noise makes a crest of E along it: a ridge as deep as the
// noise, that is widened by the Gaussian.  It has the solid on one side only.
bool RidgeValues::is_deep(const SheetVertex& vertex, const DistanceToMesh& surface) const {
  const Vec3 place = (1 / field_.spacing) * vertex.position, wall = surface.nearest_place(place);
  const double radius = norm(place - wall);
  if (radius < std::max(least_radius(vertex), RidgeConstants::min_radius)) return false;
  double share = RidgeConstants::min_ball_share;
  if (smoothed_ != nullptr) {
    // Of the normals' difference, which is across the ridge, as much as leads to the wall.
    const Vec3 across = vertex.normal_a - vertex.normal_b;
    const double along = dot(across, place - wall) / radius, size = norm(across);
    if (size > 0) share = std::lerp(share, RidgeConstants::noisy_ball_share, along * along / (size * size));
  }
  const Vec3 ball = (1 / share) * (place - wall);  // from the wall to its middle
  return surface.nearest(wall + ball) < RidgeConstants::min_ball * norm(ball);
}

Vec3 RidgeValues::gradient(std::uint32_t point) const {
  return vector_of(derivatives_[point].gradient);
}

SheetVertex RidgeValues::at(Of of, const Vec3& position, std::span<const std::uint32_t> points,
                            std::span<const double> weights, const Vec3& across) const {
  SheetVertex vertex;
  vertex.position = position;
  // The nearest of them: the first would be on the outer side in one half of a symmetric solid, on the inner in the other.
  const auto heaviest = std::max_element(weights.begin(), weights.end());
  vertex.point = points[static_cast<std::size_t>(heaviest - weights.begin())];
  Vec3 gradient;
  double value = 0, least = 0, width = 0, radius = 0;
  for (std::size_t n = 0; n < points.size(); ++n) {
    const PointDerivatives& here = derivatives_[points[n]];
    const PointRidge& ridge = this->ridge(points[n]);
    const double w = weights[n];
    gradient = gradient + w * vector_of(here.gradient);
    value += w * static_cast<double>(here.value);
    width += w * RidgeWidths{}.at(static_cast<double>(here.depth));
    least += w * static_cast<double>(ridge.least);
    radius += w * static_cast<double>(radius_[points[n]]);
    vertex.ratio += w * static_cast<double>(ridge.ratio);
    vertex.roundness += w * static_cast<double>(ridge.roundness);
    vertex.erosion += w * field_.erosion[points[n]];
    vertex.area += w * section_area(to_mesh_, field_.gradient[points[n]]);
  }
  const double square = dot(gradient, gradient);
  if (of == Of::kCurve) {
    vertex.strength = vertex.ratio * strength_of(least, value, square);
  } else {
    const double slope = std::max(0.0, vertex.ratio) * least * RidgeConstants::strip * radius;
    vertex.strength = strength_of(least, value, square + slope * slope);
  }
  // grad P one width away along e is g -+ lambda width e, to first order.
  const Vec3 rise = (-least * width) * across;
  vertex.normal_a = unit(gradient + rise);
  vertex.normal_b = unit(gradient - rise);
  return vertex;
}

}  // namespace affskel::core
