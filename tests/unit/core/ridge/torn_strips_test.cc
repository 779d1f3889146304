#include "core/ridge/torn_strips.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/base/error.h"
#include "core/ridge/ridge_meshes.h"

namespace affskel::core {
namespace {

bool strip(double, double y) {
  return y > 13 && y < 17;
}

std::pair<double, double> extent(const RidgeCurve& curve) {
  return {curve.vertices.front().position.x, curve.vertices.back().position.x};
}

TEST(TornStrips, WholeOnesStay) {
  const SheetMesh mesh = part_of_square(30, strip);
  EXPECT_TRUE(torn_stretches(mesh, std::vector{line(2, 28, 3)}).empty());
  // A bay in a rim is no tear.
  const SheetMesh bay =
      part_of_square(30, [](double x, double y) { return strip(x, y) && !(x > 14 && x < 16 && y > 15); });
  EXPECT_TRUE(torn_stretches(bay, std::vector{line(2, 28, 3)}).empty());
}

TEST(TornStrips, ASlitTakesInWhatLiesAboutIt) {
  const SheetMesh mesh = part_of_square(
      30, [](double x, double y) { return strip(x, y) && !(x > 14 && x < 15 && y > 14 && y < 16); });
  ASSERT_EQ(topology(mesh).betti.holes, 1U);
  const auto found = torn_stretches(mesh, std::vector{line(2, 28, 6)});
  ASSERT_EQ(found.size(), 1U);
  const auto [low, high] = extent(found[0]);
  // Windows, 7.5 long, that hold all about the slit.
  EXPECT_GE(low, 8);
  EXPECT_LE(low, 13);
  EXPECT_GE(high, 16);
  EXPECT_LE(high, 21);
}

TEST(TornStrips, AGapIsOne) {
  const SheetMesh mesh =
      part_of_square(30, [](double x, double y) { return strip(x, y) && !(x > 12 && x < 20); });
  const auto found = torn_stretches(mesh, std::vector{line(2, 28, 3)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(extent(found[0]).first, 12, 2);
  EXPECT_NEAR(extent(found[0]).second, 20, 2);
}

TEST(TornStrips, CrossingSheetsThatMeetTwiceAreTorn) {
  // A second sheet over the strip that leaves and meets it in two lines: a tunnel without a rim in it.
  SheetMesh mesh = part_of_square(30, strip);
  const auto at = [&](double x, double y) {
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
      if (mesh.vertices[v].position.x == x && mesh.vertices[v].position.y == y) return v;
    return 0U;
  };
  SheetVertex top = mesh.vertices[0];
  top.position = {14.5, 14, 1};
  mesh.vertices.push_back(top);
  top.position = {14.5, 16, 1};
  mesh.vertices.push_back(top);
  mesh.part.resize(mesh.vertices.size(), 0);
  const auto b = static_cast<std::uint32_t>(mesh.vertices.size()) - 1, a = b - 1;
  for (const double x : {14.0, 15.0}) {
    const std::uint32_t low = at(x, 14), middle = at(x, 15), high = at(x, 16);
    mesh.triangles.push_back({low, middle, a});
    mesh.triangles.push_back({middle, b, a});
    mesh.triangles.push_back({middle, high, b});
  }
  ASSERT_EQ(topology(mesh).betti.holes, 1U);
  const auto found = torn_stretches(mesh, std::vector{line(2, 28, 3)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LE(extent(found[0]).first, 14);
  EXPECT_GE(extent(found[0]).second, 15);
}

TEST(TornStrips, WhatIsRoundIsTakenWholeOrNot) {
  const SheetMesh mesh = part_of_square(30, strip);
  RidgeCurve round = line(2, 28, 3);
  for (SheetVertex& v : round.vertices)
    if (v.position.x >= 20) v.ratio = 0.9;
  const auto found = torn_stretches(mesh, std::vector{round});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(extent(found[0]), (std::pair{20.0, 28.0}));
  RidgeConstants constants;
  constants.round_ratio = 0;
  EXPECT_EQ(torn_stretches(mesh, std::vector{line(2, 28, 3)}, constants).size(), 1U);
}

}  // namespace
}  // namespace affskel::core
