#include "core/curve/hub_ellipsoid.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/plain_math.h"
#include "core/base/symmetric_eigen.h"

namespace affskel::core {
namespace {

constexpr double kGrown = 1.1;  // times the ellipsoid with the moments
constexpr double kBar = 2.25;   // times as long as wide: a limb, which grows where it turns a corner

constexpr double kPerBall = 0.75 / std::numbers::pi;  // a ball's cubed radius, of its volume

double volume_of(double points, double spacing) {
  return spacing * spacing * spacing * points;
}

}  // namespace

// By how it grows there: along the way from the centre the rim of a flat body would be far away.
double HubEllipsoid::outside(const Vec3& at) const {
  const Vec3 way = at - centre, steep = form * way;
  const double square = dot(way, steep);
  if (!(square > 0)) return -std::numeric_limits<double>::infinity();
  return (square - std::sqrt(square)) / norm(steep);
}

// The mean square of a place in a ball, along an axis, is a fifth of the radius', in a cube a twelfth of the edge's.
HubEllipsoid HubEllipsoid::of(const PlaceMoments& points, double spacing) {
  const Matrix3 spread = (1 / points.count) * points.about_centre() + square_in_cell(spacing) * kIdentity3;
  return {points.centre(), (1 / (5 * kGrown * kGrown)) * inverse_transposed(spread)};
}

double HubEllipsoid::filled_by(const PlaceMoments& points, double spacing) const {
  const double ball = kPerBall * volume_of(points.count, spacing) * kGrown * kGrown * kGrown;
  return ball * std::sqrt(determinant(form));
}

std::array<double, 3> HubEllipsoid::half_axes() const {
  auto axes = symmetric_eigen(form).values;  // one over their squares
  for (double& axis : axes) axis = 1 / std::sqrt(axis);
  return axes;
}

bool HubEllipsoid::is_bar() const {
  const auto axes = half_axes();
  return axes[2] > kBar * axes[1];
}

double ball_radius(double points, double spacing) {
  return points > 0 ? cube_root(kPerBall * volume_of(points, spacing)) : 0;
}

}  // namespace affskel::core
