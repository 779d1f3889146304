#include "core/spatial/oriented_box.h"

#include <algorithm>
#include <cmath>

#include "core/base/axis_choice.h"

namespace affskel::core {
namespace {

// More than the rounding of axes, centres and projections together, which is about 2^-48.
constexpr double kMargin = 0x1p-46;

// Of a box with these half sides along these axes, along a direction.
double reach(const Matrix3& axes, const Vec3& half, const Vec3& direction) {
  return half.x * std::abs(dot(axes[0], direction)) + half.y * std::abs(dot(axes[1], direction)) +
         half.z * std::abs(dot(axes[2], direction));
}

// v / |v|, or another unit vector where v is shorter than `least` and its direction may be rounding.
Vec3 unit_or(const Vec3& v, const Vec3& other, double least) {
  const double length = norm(v);
  return length > least ? (1 / length) * v : other;
}

}  // namespace

UnitTriangles::UnitTriangles(const Mesh& mesh) : mesh_(&mesh) {
  double largest = 0;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) largest = std::max(largest, largest_component(mesh.points[v]));
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  unit_ = std::ldexp(1.0, -std::max(exponent, -1000));
}

void OrientedExtent::include(const Corners& corners) {
  along_.include(box_of(corners, axes_));
}

OrientedBox OrientedExtent::box() const {
  return {axes_, axes_ * along_.middle(), 0.5 * along_.sides()};
}

OrientedBox oriented_box(const Corners& corners) {
  Corners sides = {corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]};
  std::sort(sides.begin(), sides.end(), [](const Vec3& s, const Vec3& t) { return dot(s, s) > dot(t, t); });
  const Vec3 along = unit_or(sides[0], kIdentity3[0], 0), any = plane_axes(along)[0];
  // Twice: what rounding leaves along the side is large beside the height of a needle.
  Vec3 across = unit_or(sides[1] - dot(sides[1], along) * along, any, 0);
  across = unit_or(across - dot(across, along) * along, any, 0.5);
  OrientedExtent extent({along, across, unit(cross(along, across))});
  extent.include(corners);
  return extent.box();
}

OrientedBox oriented_box(const Box& box, double unit) {
  const Vec3 low = unit * box.low, high = unit * box.high;
  return {kIdentity3, 0.5 * (low + high), 0.5 * (high - low)};
}

bool surely_apart(const OrientedBox& a, const OrientedBox& b) {
  const Vec3 between = b.centre - a.centre;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& axis = a.axes[k];
    if (std::abs(dot(axis, between)) > a.half[k] + reach(b.axes, b.half, axis) + kMargin) return true;
  }
  return false;
}

bool surely_apart(const OrientedBox& box, const Corners& corners) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& axis = box.axes[k];
    const double p = dot(axis, corners[0] - box.centre), q = dot(axis, corners[1] - box.centre),
                 r = dot(axis, corners[2] - box.centre), most = box.half[k] + kMargin;
    if (std::min({p, q, r}) > most || std::max({p, q, r}) < -most) return true;
  }
  return false;
}

}  // namespace affskel::core
