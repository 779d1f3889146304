#include "core/shapes/body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "core/base/error.h"
#include "core/mesh_checks.h"
#include "core/shapes/body_shape.h"
#include "core/spatial/self_intersection.h"

namespace affskel::core {
namespace {

using Position = std::array<double, 3>;

std::set<Position> places(const Mesh& mesh, double mirror) {
  std::set<Position> out;
  for (const Vec3& p : mesh.points) out.insert({mirror * p.x + 0.0, p.y, p.z});
  return out;
}

/// Each is made once per process.
const Mesh& body(std::uint32_t triangles) {
  static std::map<std::uint32_t, Mesh> made;
  const auto [place, is_new] = made.try_emplace(triangles);
  if (is_new) place->second = make_body({.triangles = triangles});
  return place->second;
}

/// Volume of body_function's body by counting lattice points, mm^3; good to about 0.2 %.
double counted_volume() {
  constexpr double kSpacing = 15;
  std::int64_t inside = 0;
  for (double x = kSpacing / 2; x < kBodyHigh.x; x += kSpacing) {
    for (double y = kBodyLow.y; y < kBodyHigh.y; y += kSpacing) {
      for (double z = kBodyLow.z + kSpacing / 3; z < kBodyHigh.z; z += kSpacing) {
        inside += body_function({x, y, z}) < 0;
      }
    }
  }
  return 2 * kSpacing * kSpacing * kSpacing * static_cast<double>(inside);
}

class BodyTest : public testing::TestWithParam<std::uint32_t> {};

TEST_P(BodyTest, BoundsASymmetricSolidOfExactlyTheTrianglesAndHeight) {
  const Mesh& mesh = body(GetParam());
  EXPECT_EQ(mesh.triangles.size(), GetParam());
  expect_solid_boundary(mesh);
  EXPECT_TRUE(self_intersections(mesh, {.max_pairs = 1}).empty());
  EXPECT_EQ(places(mesh, 1), places(mesh, -1));
  const auto [low, high] = std::minmax_element(mesh.points.begin(), mesh.points.end(),
                                               [](const Vec3& a, const Vec3& b) { return a.z < b.z; });
  EXPECT_EQ(low->z, 0);
  EXPECT_NEAR(high->z, 1800, 1e-9);
}

TEST_P(BodyTest, KeepsTheVolumeOfTheImplicitBody) {
  EXPECT_NEAR(mesh_facts(body(GetParam())).volume / counted_volume(), 1, 0.01);
}

TEST_P(BodyTest, HasTheLimbsOfAHuman) {
  const Mesh& mesh = body(GetParam());
  // Heights that no vertex of these meshes has: two legs, trunk between two arms, head.
  EXPECT_EQ(section_curves(mesh, 0.251 * 1800), 2u);
  EXPECT_EQ(section_curves(mesh, 0.4001 * 1800), 2u);
  EXPECT_EQ(section_curves(mesh, 0.5501 * 1800), 3u);
  EXPECT_EQ(section_curves(mesh, 0.6501 * 1800), 3u);
  EXPECT_EQ(section_curves(mesh, 0.9001 * 1800), 1u);

  // It faces along negative y, on flat feet.
  double toes = 0, heels = 0;
  int on_the_ground = 0;
  for (const Vec3& p : mesh.points) {
    if (p.z > 0.03 * 1800) continue;
    toes = std::min(toes, p.y);
    heels = std::max(heels, p.y);
    on_the_ground += p.z == 0;
  }
  EXPECT_LT(toes, -150);
  EXPECT_GT(heels, 40);
  EXPECT_LT(heels, 120);
  EXPECT_GE(on_the_ground, GetParam() < 250 ? 4 : 6);
}

INSTANTIATE_TEST_SUITE_P(Counts, BodyTest, testing::Values(200u, 292u, 500u, 20002u));

TEST(MakeBodyTest, IsAFunctionOfItsOptions) {
  const Mesh first = make_body(), second = make_body();
  EXPECT_EQ(first.points, second.points);
  EXPECT_EQ(first.triangles, second.triangles);
}

TEST(MakeBodyTest, ScalesWithTheHeight) {
  const Mesh tall = make_body({.triangles = 300, .height = 1800});
  const Mesh small = make_body({.triangles = 300, .height = 1.75});
  EXPECT_EQ(tall.triangles, small.triangles);
  ASSERT_EQ(tall.points.size(), small.points.size());
  for (std::size_t i = 0; i < tall.points.size(); ++i) {
    EXPECT_NEAR(norm(small.points[i] - (1.75 / 1800) * tall.points[i]), 0, 1e-14 * 1800);
  }
}

TEST(MakeBodyTest, RefusesBadOptions) {
  for (const MakeBodyOptions& options :
       {MakeBodyOptions{.triangles = 198}, MakeBodyOptions{.triangles = 501},
        MakeBodyOptions{.triangles = 200002}, MakeBodyOptions{.height = 0}, MakeBodyOptions{.height = -1},
        MakeBodyOptions{.height = std::nan("")}}) {
    try {
      make_body(options);
      ADD_FAILURE() << "accepted " << options.triangles << " triangles, height " << options.height;
    } catch (const CoreError& error) {
      EXPECT_EQ(error.code(), CoreError::Code::kBadInput);
    }
  }
}

}  // namespace
}  // namespace affskel::core
