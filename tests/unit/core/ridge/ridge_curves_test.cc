#include "core/ridge/ridge_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/base/unit.h"
#include "core/chords/chord_fields.h"
#include "core/ridge/smoothed_derivatives.h"
#include "core/shapes/shapes.h"
#include "core/spatial/distance_to_mesh.h"
#include "core/stopping_context.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// E = 100 + slope w - steep q^2 - flat r^2 in the coordinates (q, r, w) about a line.
struct Limb {
  Vec3 foot{9.3, 9.1, 8.8};  // of the line w
  Vec3 along;
  double slope = 2, steep = 0.4, flat = 0.3;

  Vec3 q() const { return unit(cross(along, std::abs(along.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})); }
  Vec3 r() const { return cross(along, q()); }
  Branch branch() const {
    return {[this](const Vec3& u) {
              const Vec3 off = u - foot;
              const double a = dot(off, q()), b = dot(off, r());
              return 100 + slope * dot(off, along) - steep * a * a - flat * b * b;
            },
            [this](const Vec3& u) {
              const Vec3 off = u - foot;
              return slope * along - (2 * steep * dot(off, q())) * q() - (2 * flat * dot(off, r())) * r();
            }};
  }
};

std::vector<RidgeCurve> curves_of(const BoxLattice& box, const FrameField& field, double min_strength = 0.5,
                                  float radius = 100, ExecutionContext* context = nullptr) {
  const std::vector<PointDerivatives> derivatives =
      smoothed_derivatives(box.lattice, field, 1, nullptr, {.least = 1, .greatest = 1});
  const std::vector<float> everywhere(box.lattice.points, radius);
  const double low = 10 - static_cast<double>(radius), side = 2 * static_cast<double>(radius);
  const Mesh walls = moved(make_box(side, side, side), {low, low, low});  // lattice coordinates
  const DistanceToMesh nearest(walls);
  const RidgeValues values(box.lattice, field, derivatives, everywhere, nearest, nullptr, min_strength);
  return ridge_curves(box.lattice, values, context);
}

// The longest curve: at the walls of the box, where the field ends, others may be.
const RidgeCurve& longest(const std::vector<RidgeCurve>& curves) {
  return *std::max_element(curves.begin(), curves.end(), [](const RidgeCurve& a, const RidgeCurve& b) {
    return a.vertices.size() < b.vertices.size();
  });
}

// Along a line in any direction E bends by 2 steep and 2 flat across it, and not along it.
TEST(RidgeCurves, FollowTheLineWhereEIsGreatestAcross) {
  const BoxLattice box(19, 19, 19);
  for (const Vec3& direction : {Vec3{0, 0, 1}, Vec3{0.1, 0.2, 1}, Vec3{1, 0.6, -0.5}, Vec3{-1, 1, 1}}) {
    const Limb limb{.along = unit(direction)};
    const std::vector<RidgeCurve> curves = curves_of(box, field_of_branches(box.lattice, {limb.branch()}));
    ASSERT_FALSE(curves.empty());
    const RidgeCurve& curve = longest(curves);
    EXPECT_FALSE(curve.closed);
    double low = 1e300, high = -1e300, length = 0;
    for (std::size_t n = 0; n < curve.vertices.size(); ++n) {
      const SheetVertex& v = curve.vertices[n];
      const Vec3 off = v.position - limb.foot;
      const double w = dot(off, limb.along);
      low = std::min(low, w);
      high = std::max(high, w);
      if (std::abs(w) > 4) continue;  // the box's walls are near
      if (n > 0) length += norm(v.position - curve.vertices[n - 1].position);
      EXPECT_LT(norm(off - w * limb.along), 0.05);
      const double erosion = 100 + limb.slope * w;
      EXPECT_NEAR(v.erosion, erosion, 0.5);
      EXPECT_NEAR(v.ratio, limb.flat / limb.steep, 0.02);
      EXPECT_NEAR(v.strength, 2 * limb.flat * erosion / (limb.slope * limb.slope), 0.05 * v.strength);
      EXPECT_NEAR(v.area, limb.slope, 0.2);
    }
    EXPECT_LT(low, -6);
    EXPECT_GT(high, 6);
    EXPECT_NEAR(length, 8, 1);  // neither doubled nor in zigzag
  }
}

TEST(RidgeCurves, CloseWhereEIsGreatestOnACircle) {
  const BoxLattice box(21, 21, 13);
  const Vec3 centre{10.1, 9.9, 6.2};
  const double radius = 6;
  const Branch ring{[&](const Vec3& u) {
                      const Vec3 off = u - centre;
                      const double away = std::hypot(off.x, off.y) - radius;
                      return 100 - away * away - 0.8 * off.z * off.z;
                    },
                    [&](const Vec3& u) {
                      const Vec3 off = u - centre;
                      const double r = std::hypot(off.x, off.y), pull = -2 * (r - radius) / r;
                      return Vec3{pull * off.x, pull * off.y, -1.6 * off.z};
                    }};
  const std::vector<RidgeCurve> curves = curves_of(box, field_of_branches(box.lattice, {ring}));
  std::size_t closed = 0;
  for (const RidgeCurve& curve : curves) {
    if (!curve.closed) continue;
    ++closed;
    // Smoothing a curved crest draws it in by about width^2 / radius.
    double length = norm(curve.vertices.front().position - curve.vertices.back().position);
    for (std::size_t n = 1; n < curve.vertices.size(); ++n)
      length += norm(curve.vertices[n].position - curve.vertices[n - 1].position);
    EXPECT_NEAR(length, 2 * std::numbers::pi * radius, 2);
    for (const SheetVertex& v : curve.vertices) {
      EXPECT_NEAR(std::hypot(v.position.x - centre.x, v.position.y - centre.y), radius, 0.4);
      EXPECT_NEAR(v.position.z, centre.z, 0.1);
    }
  }
  EXPECT_EQ(closed, 1U);
}

TEST(RidgeCurves, EndWhereTheirBoundsAre) {
  const BoxLattice box(19, 19, 19);
  const Limb limb{.along = unit({0.1, 0.2, 1})};
  const FrameField field = field_of_branches(box.lattice, {limb.branch()});
  // s_2 = 2 flat E / slope^2 grows along the limb: at w = 0 it is 15.
  const RidgeCurve upper = longest(curves_of(box, field, 15));
  for (const SheetVertex& v : upper.vertices) EXPECT_GE(v.strength, 14.9);
  const auto above = [&](const SheetVertex& v) { return dot(v.position - limb.foot, limb.along); };
  EXPECT_NEAR(std::min(above(upper.vertices.front()), above(upper.vertices.back())), 0, 1.5);
  EXPECT_GT(std::max(above(upper.vertices.front()), above(upper.vertices.back())), 6);
  EXPECT_TRUE(curves_of(box, field, 0.5, 1).empty());
}

// In a sheet E bends in one direction alone.
TEST(RidgeCurves, AreNoneInAFlatSheet) {
  const BoxLattice box(13, 13, 13);
  Limb limb{.along = unit({0.2, 0.1, 1})};
  limb.flat = 0;
  for (const RidgeCurve& curve : curves_of(box, field_of_branches(box.lattice, {limb.branch()})))
    for (const SheetVertex& v : curve.vertices)
      EXPECT_GT(
          std::max({std::abs(v.position.x - 6), std::abs(v.position.y - 6), std::abs(v.position.z - 6)}),
          2.5);
}

TEST(RidgeCurves, StopWhenTheContextAsks) {
  const BoxLattice box(5, 5, 5);
  const Limb limb{.along = {0, 0, 1}};
  StoppingContext context(0);
  EXPECT_THROW(curves_of(box, field_of_branches(box.lattice, {limb.branch()}), 0.5, 100, &context),
               CoreError);
}

}  // namespace
}  // namespace affskel::core
