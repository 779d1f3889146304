#include "core/curve/hanging_patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/curve/curved.h"
#include "core/shapes/implicit_mesh.h"

namespace affskel::core {
namespace {

constexpr std::uint32_t kSquares = 10, kPerRow = kSquares + 1;

// A square of kSquares squares on a side, two triangles each, and a line that goes away from its corner 0.
SheetMesh patch_on_a_line() {
  SheetMesh sheet;
  const auto put = [&](double x, double y) {
    SheetVertex vertex;
    vertex.position = {x, y, 0};
    sheet.vertices.push_back(vertex);
  };
  for (std::uint32_t j = 0; j < kPerRow; ++j)
    for (std::uint32_t i = 0; i < kPerRow; ++i) put(i, j);
  for (std::uint32_t j = 0; j < kSquares; ++j)
    for (std::uint32_t i = 0; i < kSquares; ++i) {
      const std::uint32_t a = j * kPerRow + i, b = a + 1, c = b + kPerRow, d = a + kPerRow;
      sheet.triangles.insert(sheet.triangles.end(), {{a, b, c}, {a, c, d}});
    }
  const auto first = static_cast<std::uint32_t>(sheet.vertices.size());
  for (std::uint32_t n = 1; n < 6; ++n) put(-double(n), 0);
  sheet.segments.push_back({0, first});
  for (std::uint32_t n = 1; n < 5; ++n) sheet.segments.push_back({first + n - 1, first + n});
  return sheet;
}

std::vector<HangingPatch> found(const SheetMesh& sheet, std::vector<std::uint32_t> ends = {}) {
  const std::vector<double> ball(sheet.vertices.size(), 1);
  std::vector<char> has_end(sheet.vertices.size(), 0);
  for (const std::uint32_t v : ends) has_end[v] = 1;
  return hanging_patches(sheet, ball, has_end);
}

TEST(HangingPatches, EndFarthestFromTheirLine) {
  const std::vector<HangingPatch> patches = found(patch_on_a_line());
  ASSERT_EQ(patches.size(), 1U);
  EXPECT_EQ(patches[0].end, kPerRow * kPerRow - 1) << "the other corner";
  // The middle is half a side from the rims, and a ball of 1 beside it.
  EXPECT_NEAR(patches[0].width, 0.5 * kSquares + 1, 1e-9);
}

TEST(HangingPatches, HaveNoEndNoTunnelAndOneLine) {
  EXPECT_TRUE(found(patch_on_a_line(), {kPerRow * 5 + 5}).empty());
  EXPECT_EQ(found(patch_on_a_line(), {kPerRow * kPerRow + 4}).size(), 1U) << "an end of the line alone";
  SheetMesh pierced = patch_on_a_line();
  pierced.triangles.erase(pierced.triangles.begin() + 2 * (4 * kSquares + 4));
  EXPECT_TRUE(found(pierced).empty());
  SheetMesh between = patch_on_a_line();
  between.segments.push_back({kSquares, kPerRow * kPerRow + 4});
  EXPECT_TRUE(found(between).empty()) << "two lines";
  SheetMesh alone = patch_on_a_line();
  alone.segments.erase(alone.segments.begin());
  EXPECT_TRUE(found(alone).empty());
}

// A round paddle on a stalk, as wide as long, beside a trunk: three ends, and the paddle is a part.
TEST(HangingPatches, OfASolidAreFlatLimbs) {
  const auto rod = [](const Vec3& p, const Vec3& a, const Vec3& b, double radius) {
    const Vec3 along = b - a;
    const double t = std::clamp(dot(p - a, along) / dot(along, along), 0.0, 1.0);
    return norm(p - a - t * along) - radius;
  };
  const ImplicitFunction f = [&](const Vec3& p) {
    const Vec3 q = p - Vec3{4.5, 0, 0};
    const double paddle = std::hypot(std::max(std::hypot(q.x, q.y) - 1.5, 0.0), q.z) - 0.3;
    return std::min({paddle, rod(p, {0, -4, 0}, {0, 4, 0}, 0.8), rod(p, {0, 0, 0}, {3.2, 0, 0}, 0.3)});
  };
  Mesh mesh = mesh_zero_set(f, {{-2, -6, -2}, {8, 6, 2}, 0.15});
  fair_onto(f, 1e-3, 3, mesh);
  const Curved solid(mesh, 0.1, "sphere:320");
  const CurveSkeleton curve = solid.at();
  EXPECT_EQ(curve.ends, 3U);
  EXPECT_EQ(curve.branches, 3U);
  double farthest = 0;
  for (const SheetVertex& vertex : curve.vertices) farthest = std::max(farthest, solid.place(vertex).x);
  EXPECT_GT(farthest, 5) << "into the paddle";
  EXPECT_EQ(solid.at(6).ends, 2U) << "long limbs alone";
  EXPECT_EQ(solid.at(std::nextafter(curve.same_to, 0)).ends, 3U);
}

}  // namespace
}  // namespace affskel::core
