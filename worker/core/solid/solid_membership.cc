#include "core/solid/solid_membership.h"

#include <cmath>

namespace affskel::core {
namespace {

// Less than this many times as many are clearly fewer: rounding does not choose.
constexpr double kFewer = 0.8;

// Along which lines through the box cross the fewest triangles, in the mean.
int axis_of_fewest(const Mesh& mesh, const Box& box) {
  Vec3 shadow;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 area = twice_area(mesh, t);
    shadow = shadow + Vec3{std::abs(area.x), std::abs(area.y), std::abs(area.z)};
  }
  const Vec3 sides = box.sides();
  const auto crossings = [&](int a) { return shadow[a] * sides[a]; };  // by the volume of the box
  int best = 0;
  for (int a = 1; a < 3; ++a)
    if (crossings(a) < kFewer * crossings(best)) best = a;
  return best;
}

}  // namespace

SolidMembership::SolidMembership(const Mesh& mesh, unsigned threads)
    : rays_(mesh, threads), box_(box_of(mesh)), axis_(axis_of_fewest(mesh, box_)) {}

int SolidMembership::winding_number(const Vec3& q) const {
  const bool upward = box_.high[axis_] - q[axis_] < q[axis_] - box_.low[axis_];
  return rays_.shoot(q, axis_, upward).winding;
}

}  // namespace affskel::core
