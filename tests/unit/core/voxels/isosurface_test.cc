#include "core/voxels/isosurface.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "base/coding.h"
#include "core/base/error.h"
#include "core/mesh_checks.h"
#include "core/shapes/body_shape.h"
#include "core/solid/solid.h"
#include "core/spatial/self_intersection.h"
#include "core/stopping_context.h"
#include "tools/peak_memory.h"

namespace affskel::core {
namespace {

// A function of places at the voxels of a grid.
VoxelImage sampled(const std::array<std::size_t, 3>& size, const AffineMap& place,
                   const std::function<double(const Vec3&)>& f) {
  std::string values;
  for (std::size_t k = 0; k < size[2]; ++k)
    for (std::size_t j = 0; j < size[1]; ++j)
      for (std::size_t i = 0; i < size[0]; ++i)
        base::append(values, static_cast<float>(f(place(
                                 {static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)}))));
  return {size, place, base::PackedNumbers(std::move(values), base::kNumberKind<float>)};
}

AffineMap grid(const Vec3& low, double step) {
  AffineMap map = scaling(step, step, step);
  map.shift = low;
  return map;
}

double ball(const Vec3& p) {
  return norm(p - Vec3{3, -2, 1}) - 10;
}

// Whichever side is the solid, and whatever the grid's axes are: the volume is the ball's, the surface faces outward.
TEST(Isosurface, OfABallHasItsVolume) {
  const double volume = 4.0 / 3 * M_PI * 1000;
  AffineMap mirrored = grid({-9, -14, 13}, 1);
  mirrored.rows[2].z = -1;
  AffineMap sheared = then(grid({-13, -15, -12}, 1), shear(0, 2, 0.3));
  for (const AffineMap& place : {grid({-9, -14, -11}, 1), mirrored, sheared}) {
    for (const double sign : {1.0, -1.0}) {
      const VoxelImage image =
          sampled({33, 27, 26}, place, [&](const Vec3& p) { return 5 + sign * ball(p); });
      const Isosurface found = isosurface(image, {5});
      EXPECT_EQ(found.below, sign > 0);
      EXPECT_FALSE(found.cut);
      const Solid solid = make_solid(found.mesh);
      EXPECT_TRUE(solid.notes.empty());
      EXPECT_NEAR(solid.volume / volume, 1, 0.01);
      for (const Vec3& p : found.mesh.points) EXPECT_LT(std::abs(ball(p)), 0.15);
    }
  }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// A mask has the same two values everywhere: what is far from its surface takes no memory, whose cubes would take 200 MB.
TEST(IsosurfaceDeathTest, OfAMaskLooksAtWhatIsNearAlone) {
  const VoxelImage image = sampled({160, 160, 160}, grid({-80, -80, -80}, 1),
                                   [](const Vec3& p) { return ball(p) < 0 ? 1.0 : 0.0; });
  EXPECT_EXIT(
      {
        const std::uint64_t before = tests::peak_memory();
        const Isosurface found = isosurface(image, {0.5});
        _exit(!found.below && tests::peak_memory() - before < (48U << 20) ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}
#endif

// What the image's border cuts off is closed there.
TEST(Isosurface, IsClosedWhereTheSolidLeavesTheImage) {
  const VoxelImage image = sampled({31, 31, 14}, grid({-12, -17, -14}, 1), ball);
  const Isosurface found = isosurface(image, {0});
  const Solid solid = make_solid(found.mesh);
  EXPECT_TRUE(found.cut);
  EXPECT_TRUE(solid.notes.empty());
  EXPECT_LT(solid.volume, 4.0 / 3 * M_PI * 1000 * 0.6);
}

TEST(Isosurface, OfAMaskIsASolid) {
  const VoxelImage image =
      sampled({31, 31, 31}, grid({-12, -17, -14}, 1), [](const Vec3& p) { return ball(p) < 0 ? 1.0 : 0.0; });
  const Solid solid = make_solid(isosurface(image, {0.5}).mesh);
  EXPECT_NEAR(solid.volume / (4.0 / 3 * M_PI * 1000), 1, 0.02);
}

TEST(Isosurface, OfABodyIsTheBodyAtFewerTriangles) {
  const VoxelImage image = sampled({80, 36, 96}, grid(kBodyLow, 20), body_function);
  const Isosurface fine = isosurface(image, {0, 1000000}), coarse = isosurface(image, {0, 5000});
  EXPECT_GT(fine.mesh.triangles.size(), 15000U);
  EXPECT_EQ(coarse.mesh.triangles.size(), 5000U);
  const Solid whole = make_solid(fine.mesh), fewer = make_solid(coarse.mesh);
  EXPECT_NEAR(fewer.volume / whole.volume, 1, 0.002);
  for (const Vec3& p : coarse.mesh.points) EXPECT_LT(std::abs(body_function(p)), 20);
}

// The end of a groove is less wide than a voxel: the block still has no tunnel there, and its walls do not pass through each
// other.
TEST(Isosurface, OfAGroovedBlockIsAsTheImage) {
  for (const double degrees : {20, 45, 60, 90}) {
    for (const double turned : {0.0, 0.4}) {
      const Vec3 wall{-std::sin(degrees * M_PI / 180), std::cos(degrees * M_PI / 180), 0};
      const VoxelImage image = sampled({33, 33, 33}, grid({-4, -4, -4}, 0.25), [&](const Vec3& p) {
        const Vec3 q{std::cos(turned) * p.x + std::sin(turned) * p.z, p.y,
                     std::cos(turned) * p.z - std::sin(turned) * p.x};
        const double block = std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)}) - 2.8;
        return std::max(block, -std::max(-q.y, dot(wall, q)));
      });
      const std::size_t triangles = degrees == 45 ? 4000 : 20000;
      const Mesh mesh = isosurface(image, {.isovalue = 0, .max_triangles = triangles}).mesh;
      expect_solid_boundary(mesh);
      EXPECT_TRUE(self_intersections(mesh).empty());
    }
  }
}

// Of labels 0, 1 and 2 the value 1 bounds what is above it, as 1.5 does, but nearer to the ones.
TEST(Isosurface, AtAValueThatVoxelsHaveIsASolid) {
  const auto shell = [](double sign, double outer, double inner) {
    return sampled({31, 31, 31}, grid({-12, -17, -14}, 1), [=](const Vec3& p) {
      return sign * (ball(p) < inner - 10 ? 2 : ball(p) < outer - 10 ? 1 : 0);
    });
  };
  for (const double sign : {1.0, -1.0}) {
    const Solid labels = make_solid(isosurface(shell(sign, 12, 6), {sign}).mesh);
    EXPECT_NEAR(labels.volume / (4.0 / 3 * M_PI * 6.75 * 6.75 * 6.75), 1, 0.05);
    if (sign < 0) continue;  // the range of values has its lower end alone
    // The border is of the value, too.
    const Solid bright = make_solid(isosurface(shell(sign, 100, 6), {sign}).mesh);
    EXPECT_NEAR(bright.volume / labels.volume, 1, 1e-9);
  }
}

TEST(Isosurface, StopsWhenAsked) {
  const VoxelImage image = sampled({31, 31, 31}, grid({-12, -17, -14}, 1), ball);
  expect_stops_wherever_it_is_asked(40, [&](ExecutionContext* context) {
    isosurface(image, {.isovalue = 0, .max_triangles = 1000, .context = context});
  });
}

TEST(Isosurface, SaysThatThereIsNoSuchValue) {
  const VoxelImage image = sampled({8, 8, 8}, AffineMap(), ball);
  EXPECT_THROW(isosurface(image, {1000}), CoreError);
  EXPECT_THROW(isosurface(image, {-1000}), CoreError);
}

}  // namespace
}  // namespace affskel::core
