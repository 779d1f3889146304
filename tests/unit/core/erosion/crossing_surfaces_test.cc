#include <gtest/gtest.h>

#include <cmath>

#include "core/erosion/computed.h"
#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

// Surfaces that cross themselves.

namespace affskel::core {
namespace {

// A prism over a bow tie: one half is inside out, where chords say nothing.
TEST(ErosionOfCrossingSurfaces, EveryPointGetsADirectionEvenWhereChordsSayNothing) {
  Mesh bow;
  for (double z : {0.0, 1.0}) {
    for (const Vec3& p : {Vec3{0, 0, z}, Vec3{2, 2, z}, Vec3{2, 0, z}, Vec3{0, 2.4, z}})
      bow.points.push_back(p);
  }
  bow.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    bow.triangles.push_back({i, j, j + 4});
    bow.triangles.push_back({i, j + 4, i + 4});
  }
  const Solid solid = make_solid(bow);
  ASSERT_TRUE(solid.self_intersecting);
  const Computed field = compute(bow, 0.1, "random:1:2");
  for (const FieldValue& value : field.value) {
    EXPECT_NE(value.direction, FieldValue::kNoDirection);
    EXPECT_TRUE(std::isfinite(value.erosion) && value.erosion >= 0);
  }
}

// A bar of two overlapping boxes: near the end of one of them it goes on in the other.
TEST(ErosionOfCrossingSurfaces, PartsThatOverlapAreErodedAsOne) {
  const Mesh bar = joined(make_box(2, 1, 1), moved(make_box(2, 1, 1), {1.5, 0.1, 0.05}));
  const Computed t = compute(bar, 0.1, "sphere:500");
  int inner = 0;
  for (std::size_t i = 0; i < t.place.size(); ++i) {
    const Vec3& p = t.place[i];
    if (!(p.x > 1.6 && p.x < 1.9 && std::abs(p.y - 0.55) < 0.1 && std::abs(p.z - 0.5) < 0.1)) continue;
    ++inner;
    EXPECT_GT(t.value[i].erosion, 0.5) << "the box alone has less than 0.4 beyond the point";
  }
  EXPECT_GT(inner, 5);
}

TEST(ErosionOfCrossingSurfaces, ComputesMeshesThatCrossThemselvesTheSameInAnyOrder) {
  const Mesh crossing = joined(make_sphere(1, 320), moved(make_sphere(1, 320), {0.7, 0.1, 0.2}));
  const Computed plain = compute(crossing, 0.1, "triangles", {1, false, 0});
  ASSERT_TRUE(plain.solid.self_intersecting);
  EXPECT_TRUE(same_bytes(plain, compute(crossing, 0.1, "triangles", {2, true, 5})));
  for (const FieldValue& value : plain.value) EXPECT_TRUE(std::isfinite(value.erosion));
}

// Volumes fall where folds turn the surface inside out.
TEST(ErosionOfCrossingSurfaces, PruningDoesNotChangeABitOfNoisyMeshes) {
  const Mesh body = make_body({300, 1800});
  std::uint64_t crossing = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    for (const Mesh& mesh : {perturb(body, {0.005 * static_cast<double>(seed) * box_diagonal(body), seed}),
                             shaken(make_sphere(600, 320), 30.0 * static_cast<double>(seed), seed)}) {
      const Computed plain = compute(mesh, 40, "triangles+random:50:3", {1, false, 0});
      crossing += plain.solid.self_intersecting;
      const Computed pruned = compute(mesh, 40, "triangles+random:50:3");
      EXPECT_TRUE(same_bytes(plain, pruned)) << seed;
      EXPECT_TRUE(same_bytes(plain, compute(mesh, 40, "triangles+random:50:3", {2, true, seed}))) << seed;
      EXPECT_LT(2 * pruned.counts.evaluated, plain.counts.evaluated);
    }
  }
  EXPECT_GE(crossing, 8U);
}

}  // namespace
}  // namespace affskel::core
