#include "core/quality/skeleton_quality.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/normal_block.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// H on a block of 20 x 20 x 20 points at spacing 0.5: `h(i, j, k)`.
template <class H>
std::vector<double> fill(H h) {
  std::vector<double> divergence;
  for (std::uint32_t i = 0; i < 20; ++i) {
    for (std::uint32_t j = 0; j < 20; ++j) {
      for (std::uint32_t k = 0; k < 20; ++k) divergence.push_back(h(i, j, k));
    }
  }
  return divergence;
}

struct Block {
  NormalBlock normals{{20, 20, 20}, 0.5};
  SkeletonQuality of(const std::vector<double>& divergence, double threshold = 7) const {
    SkeletonQualityOptions options;
    options.threshold = threshold;
    return skeleton_quality(normals.solid, normals.lattice, OptimalDirections(8000, 0), divergence, options);
  }
};

// Two layers with a square hole; a corner of the sheet falls short of the next threshold.
TEST(SkeletonQuality, OfASheetWithAHole) {
  const auto in_sheet = [](auto i, auto j, auto k) {
    return (k == 9 || k == 10) && !(i > 7 && i < 12 && j > 7 && j < 12);
  };
  const SkeletonQuality quality = Block().of(fill([&](auto i, auto j, auto k) {
    if (!in_sheet(i, j, k)) return 1.0;
    return i < 3 && j < 4 ? 8.0 : -10.0;
  }));
  EXPECT_EQ(quality.points, 2U * (400 - 16));
  EXPECT_EQ(quality.skeleton, (BettiNumbers{1, 1, 0}));
  EXPECT_EQ(quality.mean_thickness, 2);
  EXPECT_EQ(quality.inside_share, 1);
  EXPECT_EQ(quality.solid, (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(quality.other_threshold, 9);
  EXPECT_EQ(quality.hausdorff_there, 3 * 0.5);  // (0, 0) to (3, 0)
  EXPECT_EQ(quality.hausdorff_back, 0);
  // Within half a diagonal: the sheet's own voxels, and less than half of the layers beside them.
  EXPECT_GT(quality.chance_level, 2 * 384. / 8000);
  EXPECT_LT(quality.chance_level, 3 * 400. / 8000);
  EXPECT_EQ(quality.advice.text, "");
}

TEST(SkeletonQuality, HasNoDistanceToAnEmptySkeleton) {
  const SkeletonQuality quality =
      Block().of(fill([](auto i, auto j, auto k) { return i + j + k < 3 ? 8.0 : 0.0; }));
  EXPECT_EQ(quality.points, 10U);
  EXPECT_FALSE(quality.hausdorff_there.has_value());
  EXPECT_FALSE(quality.hausdorff_back.has_value());
  EXPECT_EQ(quality.advice.text, "");
}

TEST(SkeletonQuality, ExplainsWhyItIsEmpty) {
  const SkeletonQuality quality = Block().of(std::vector<double>(8000, 5));
  EXPECT_EQ(quality.points, 0U);
  EXPECT_EQ(quality.skeleton, BettiNumbers{});
  EXPECT_EQ(quality.mean_thickness, 0);
  EXPECT_EQ(quality.chance_level, 0);
  EXPECT_NE(quality.advice.text.find("A threshold of 4.95 would keep 8000"), std::string::npos)
      << quality.advice.text;
}

// The test of the points is a real one: the lattice of a ball against a solid that is only its right half.
TEST(SkeletonQuality, NoticesPointsOutsideTheSolid) {
  const Block block;
  Solid half = block.normals.solid;
  for (Vec3& p : half.mesh.points) p.x = std::max(p.x, 0.0);
  const SkeletonQuality quality =
      skeleton_quality(half, block.normals.lattice, OptimalDirections(8000, 0), std::vector<double>(8000, 8));
  EXPECT_EQ(quality.inside_share, 0.5);
}

// Sample points on the faces of the box count as inside.
TEST(SkeletonQuality, CountsTheSurfaceAsInside) {
  const Solid solid = make_solid(make_box(4, 4, 4));
  LatticeGrid grid;
  const double inner = 1 / solid.scale();
  grid.origin = inner * Vec3{-2, -2, -2};
  grid.axes = {Vec3{inner, 0, 0}, Vec3{0, inner, 0}, Vec3{0, 0, inner}};
  grid.dims = {5, 5, 5};
  const Lattice lattice = make_lattice(solid, grid);
  ASSERT_GT(lattice.points, 27U);
  EXPECT_EQ(skeleton_quality(solid, lattice, OptimalDirections(lattice.points, 0),
                             std::vector<double>(lattice.points, 8))
                .inside_share,
            1);
}

TEST(SkeletonQuality, RefusesABadThreshold) {
  EXPECT_THROW(Block().of(std::vector<double>(8000, 5), 0), CoreError);
  EXPECT_THROW(Block().of(std::vector<double>(8000, 5), std::nan("")), CoreError);
}

// A closed ring of squares in the middle of the block, in coordinates of the frame.
Mesh ring(double half) {
  Mesh mesh;
  for (const double r : {half, 2 * half}) {
    for (const auto& [x, y] : {std::pair{-r, -r}, {r, -r}, {r, r}, {-r, r}}) mesh.points.push_back({x, y, 0});
  }
  for (std::uint32_t s = 0; s < 4; ++s) {
    const std::uint32_t t = (s + 1) % 4;
    mesh.triangles.push_back({s, 4 + s, 4 + t});
    mesh.triangles.push_back({s, 4 + t, t});
  }
  return moved(mesh, {4.75, 4.75, 4.75});
}

TEST(SheetQuality, IsThatOfTheTriangles) {
  const Block block;
  const Mesh sheet = ring(1.5), other = ring(1);
  SheetQualityOptions options;
  options.other = &other;
  options.other_threshold = 0.3;
  const SkeletonQuality quality = sheet_quality(block.normals.solid, block.normals.lattice, sheet, options);
  EXPECT_EQ(quality.points, 8U);
  EXPECT_EQ(quality.skeleton, (BettiNumbers{1, 1, 0}));
  EXPECT_EQ(quality.mean_thickness, 1);
  EXPECT_EQ(quality.inside_share, 1);
  EXPECT_EQ(quality.other_threshold, 0.3);
  EXPECT_NEAR(quality.hausdorff_there.value(), std::sqrt(2.0), 1e-14);  // (3, 3) to (2, 2)
  EXPECT_NEAR(quality.hausdorff_back.value(), std::sqrt(0.5), 1e-14);   // (1, 1) to (1.5, 1.5)
}

TEST(SheetQuality, CountsCurves) {
  const Block block;
  Mesh sheet = ring(1.5), other = ring(1);
  const auto end = static_cast<std::uint32_t>(sheet.points.size());
  sheet.points.push_back({4.75, 4.75, 5.25});
  const std::vector<std::array<std::uint32_t, 2>> segments{{0, end}, {end, 1}};
  SheetQualityOptions options;
  options.segments = segments;
  const SkeletonQuality quality = sheet_quality(block.normals.solid, block.normals.lattice, sheet, options);
  EXPECT_EQ(quality.points, 9U);
  EXPECT_EQ(quality.skeleton, (BettiNumbers{1, 2, 0}));
  // Without a triangle it is a curve, one voxel thick.
  Mesh curve;
  curve.points = {{4, 4, 4}, {5, 5, 5}};
  const std::vector<std::array<std::uint32_t, 2>> one{{0, 1}};
  options.segments = one;
  options.other = &other;
  const SkeletonQuality alone = sheet_quality(block.normals.solid, block.normals.lattice, curve, options);
  EXPECT_EQ(alone.points, 2U);
  EXPECT_EQ(alone.mean_thickness, 1);
  EXPECT_TRUE(alone.hausdorff_there.has_value());
  EXPECT_GT(alone.chance_level, 0);
}

TEST(SheetQuality, NoticesVerticesOutside) {
  const Block block;
  EXPECT_EQ(sheet_quality(block.normals.solid, block.normals.lattice, ring(3)).inside_share, 0.5);
  EXPECT_EQ(sheet_quality(block.normals.solid, block.normals.lattice, {}).points, 0U);
}

}  // namespace
}  // namespace affskel::core
