#include "core/curve/limb_sections.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/split_mix64.h"
#include "core/base/unit.h"
#include "core/curve/tubes.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

TEST(LimbSections, OfATiltedPlaneThroughACylinderIsAnEllipseAboutItsAxis) {
  const Mesh cylinder = make_cylinder(1, 8, 128);
  const LimbSections sections(cylinder);
  for (const double tilt : {0., 0.4}) {
    const Vec3 across = unit({tilt, 0, 1});
    const LimbSection section = sections.at({0.3, -0.2, 4}, across, 0.75);
    EXPECT_NEAR(section.centre.x, 0, 0.02) << tilt;
    EXPECT_NEAR(section.centre.y, 0, 0.02) << tilt;
    EXPECT_NEAR(dot(section.centre - Vec3{0.3, -0.2, 4}, across), 0, 1e-12);
    EXPECT_NEAR(section.radius, std::sqrt(1 / across.z), 0.01) << "of a disc as large";
  }
}

TEST(LimbSections, ThicknessIsATubesRadiusBesideADentToo) {
  Mesh tube = make_cylinder(1, 8, 128);
  EXPECT_NEAR(LimbSections(tube).thickness({0, 0, 4}, 1), 1, 0.03);
  const Mesh with_dent = joined(tube, reversed(moved(make_sphere(0.1, 200), {0.5, 0, 4})));
  EXPECT_NEAR(LimbSections(with_dent).thickness({0, 0, 4}, 1), 1, 0.03)
      << "the distance to the surface is 0.4";
}

// The wedge between two planes through the axis of a torus has its centroid farther out than the circle.
TEST(LimbSections, OfATorusIsADiscAboutItsCircle) {
  const Mesh torus = make_torus(3, 1, 20000);
  const LimbSection section = LimbSections(torus).at({2.6, 0, 0.1}, {0, 1, 0}, 1);
  EXPECT_NEAR(section.centre.x, 3, 0.02);
  EXPECT_NEAR(section.centre.z, 0, 0.02);
  EXPECT_NEAR(section.radius, 1, 0.01);
}

TEST(LimbSections, ANeighbourInThePlaneIsNotSeen) {
  const Mesh both = joined(make_cylinder(1, 8, 64), moved(make_cylinder(1, 8, 64), {2.1, 0, 0}));
  const LimbSection section = LimbSections(both).at({0.1, 0, 4}, {0, 0, 1}, 1);
  EXPECT_NEAR(section.centre.x, 0, 0.01);
  EXPECT_NEAR(section.radius, 1, 0.01);
}

// Rays along a long box end at kWidest times the middle one.
TEST(LimbSections, RaysAreNoLongerThanTwiceTheMiddleOne) {
  const Mesh box = make_box(20, 1, 1);
  const LimbSection section = LimbSections(box).at({10, 0.5, 0.5}, {0, 0, 1}, 7.5);
  EXPECT_NEAR(section.centre.x, 10, 1e-9);
  EXPECT_LT(section.radius, 2);
}

TEST(LimbSections, AnAreaIsThatOfAllOfTheSection) {
  const Mesh box = make_box(20, 1, 1);
  const Vec3 tilted = unit({0.5, 0, 1});
  EXPECT_NEAR(LimbSections(box).area({10, 0.5, 0.5}, {0, 0, 1}, 0.3), 20, 1e-9) << "longer than rays";
  EXPECT_NEAR(LimbSections(box).area({3, 0.2, 0.9}, {1, 0, 0}, 0.3), 1, 1e-9);
  EXPECT_NEAR(LimbSections(box).area({10, 0.5, 0.5}, tilted, 0.3), std::sqrt(5.), 1e-9);
  EXPECT_EQ(LimbSections(box).area({10, 0.5, 1.5}, {1, 0, 0}, 0.3), 0) << "outside";
}

TEST(LimbSections, AnAreaHasNoPartOfWhatLiesApart) {
  const Mesh large = make_box(3, 3, 8), small = moved(make_box(1, 1, 1), {1, 1, 3.5});
  const Mesh hollow = joined(joined(large, reversed(small)), moved(make_box(2, 2, 8), {3.1, 0, 0}));
  EXPECT_NEAR(LimbSections(hollow).area({0.5, 0.5, 4}, {0, 0, 1}, 0.3), 9, 1e-9);
  EXPECT_NEAR(LimbSections(hollow).area({4, 0.5, 4}, {0, 0, 1}, 0.3), 4, 1e-9);
}

// A rod, 30 wide along x and finely divided, in the hollow of a large coarse octahedron.
TEST(LimbSections, AnAreaIsOfTheInnermostOutlineThoughAnotherIsNear) {
  const auto octahedron = [](double r) {
    Mesh mesh{{{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}}, {}};
    for (const std::uint32_t a : {0U, 1U})
      for (const std::uint32_t b : {2U, 3U})
        for (const std::uint32_t c : {4U, 5U})
          mesh.triangles.push_back((a + b + c) % 2 == 0 ? Triangle{a, b, c} : Triangle{a, c, b});
    return mesh;
  };
  Mesh rod = make_box(30, 1, 1, 30);
  for (Vec3& p : rod.points) p = p - Vec3{15, 0.5, 0.5};
  const Mesh solid = joined(joined(octahedron(101), reversed(octahedron(100))), rod);
  EXPECT_NEAR(LimbSections(solid).area({3, 0.2, 0.1}, {0, 0, 1}, 0.5), 30, 1e-9);
}

TEST(LimbSections, AnAreaIsFoundAtEveryPlace) {
  const Mesh box = make_box(4, 4, 4, 4);
  const LimbSections sections(box);
  SplitMix64 random(1);
  const auto draw = [&] { return static_cast<double>(random.next() >> 11) * 0x1p-53; };
  for (int n = 0; n < 3000; ++n) {
    const Vec3 across = unit({draw() - 0.5, draw() - 0.5, draw() - 0.5});
    EXPECT_GT(sections.area({0.5 + 3 * draw(), 0.5 + 3 * draw(), 0.5 + 3 * draw()}, across, 0.5), 1);
  }
}

TEST(LimbSections, AnEllipseIsFound) {
  Mesh flat = make_cylinder(1, 8, 128);
  for (Vec3& p : flat.points) p.x *= 2;
  const LimbEllipse ellipse = LimbSections(flat).ellipse({0, 0, 4}, {1, 0, 0}, {0, 1, 0}, 2.25);
  EXPECT_NEAR(ellipse.radius(), std::sqrt(2), 0.01);
  EXPECT_NEAR(ellipse.mean, 0.5 * (1 + 0.25), 0.01);
  EXPECT_NEAR(ellipse.cosine, 0.5 * (0.25 - 1), 0.01);
  EXPECT_NEAR(ellipse.sine, 0, 0.01);
}

// Where an arm is open to its trunk some rays leave.
TEST(LimbSections, AnOpenSideHardlyChangesTheEllipse) {
  const Mesh solid =
      tube_mesh(std::vector<Tube>{{{0, 0, -5}, {0, 0, 5}, 1}, {{0, 0, 0}, {5, 0, 0}, 0.3}}, 0.15);
  const LimbSections sections(solid);
  const LimbEllipse open = sections.ellipse({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);
  EXPECT_NEAR(open.radius(), 1, 0.06);
  EXPECT_LT(1 / std::sqrt(open.mean + open.cosine), 1.2) << "towards the arm";
}

}  // namespace
}  // namespace affskel::core
