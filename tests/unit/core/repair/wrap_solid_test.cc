#include "core/repair/wrap_solid.h"

#include <gtest/gtest.h>

#include "core/mesh/perturb.h"
#include "core/repair/repaired.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

TEST(WrapSolid, HasTheVolumeOfWhatItWraps) {
  const Mesh body = make_body({.triangles = 5000});
  const Mesh open = cut(cut(body, body.points[17], 40), body.points[900], 30);
  const RepairedMesh repaired = repair_mesh(open, {.kind = RepairKind::kWrap, .alpha = 20});
  EXPECT_NEAR(volume_of(repaired.mesh) / volume_of(body), 1, 0.02);
}

// A ball, in it a ball's cavity, in that a ball with a cavity of its own.
TEST(WrapSolid, KeepsCavitiesAndWhatLiesInThem) {
  const auto ball = [](double radius) { return make_sphere(radius, 1280); };
  const Mesh onion = joined(joined(ball(10), reversed(ball(8))), joined(ball(5), ball(3)));
  const RepairedMesh repaired = repair_mesh(onion, {.kind = RepairKind::kWrap, .alpha = 0.5});
  EXPECT_NEAR(repaired.volume / repair_mesh(onion).volume, 1, 0.01);
  ASSERT_NE(step(repaired, "wrapped"), nullptr);
  EXPECT_NE(step(repaired, "wrapped")->message.find("in 2 pieces with 2 cavities"), std::string::npos)
      << step(repaired, "wrapped")->message;
  for (const char* code : {"turned-cavities", "closed-cavities", "wrap-volume"})
    EXPECT_EQ(step(repaired, code), nullptr) << code;
  EXPECT_TRUE(make_solid(repaired.mesh).notes.empty());
}

TEST(WrapSolid, TellsCavitiesThatItCloses) {
  const Mesh box = make_box(4, 4, 4);
  const Mesh hollow = joined(box, reversed(moved(make_box(2, 2, 2), {1, 1, 1})));
  const RepairedMesh coarse = repair_mesh(hollow, {.kind = RepairKind::kWrap, .alpha = 1.5});
  ASSERT_NE(step(coarse, "closed-cavities"), nullptr);
  EXPECT_EQ(step(coarse, "closed-cavities")->count, 1U);
  ASSERT_NE(step(coarse, "wrap-volume"), nullptr);
  EXPECT_NE(step(coarse, "wrap-volume")->message.find("what it wraps 56"), std::string::npos)
      << step(coarse, "wrap-volume")->message;
  // A beam through the cavity: they hold less than the sum, for overlaps count twice, and the wrap more than that.
  const Mesh pierced = joined(hollow, moved(make_box(8, 0.5, 0.5), {-2, 1.75, 1.75}));
  const RepairedMesh beside = repair_mesh(pierced, {.kind = RepairKind::kWrap, .alpha = 0.2});
  EXPECT_NE(step(beside, "closed-cavities"), nullptr);
  EXPECT_NE(step(beside, "wrap-volume"), nullptr);
}

TEST(WrapSolid, MayHoldLessThanWhatCountsTwice) {
  const Mesh box = make_box(2, 2, 2);
  for (const Mesh& mesh : {make_coil(), joined(box, moved(box, {1, 1, 1})), joined(box, box)}) {
    const RepairedMesh repaired = repair_mesh(mesh, {.kind = RepairKind::kWrap, .alpha = 0.2});
    EXPECT_LT(repaired.volume, 0.97 * volume_of(mesh));
    EXPECT_EQ(step(repaired, "wrap-volume"), nullptr) << step(repaired, "wrap-volume")->message;
  }
}

// Walls of folds that noise makes pass each other where all of a wrap moves inward as far.
TEST(WrapSolid, MeetsItselfNowhere) {
  const Mesh body = perturb(make_body({.triangles = 500}), {.sigma = 20, .seed = 1});
  ASSERT_TRUE(make_solid(body).self_intersecting);
  const RepairedMesh repaired = repair_mesh(body, {.kind = RepairKind::kWrap, .alpha = 20});
  EXPECT_FALSE(make_solid(repaired.mesh).self_intersecting);
  EXPECT_NE(step(repaired, "wrap-volume"), nullptr)
      << "more than what it wraps has even where that counts twice";
}

TEST(WrapSolid, ClosesHolesThatAreWiderThanAlpha) {
  const Mesh ball = make_sphere(10, 1280);
  const RepairedMesh repaired =
      repair_mesh(cut(ball, {0, 0, 10}, 4), {.kind = RepairKind::kWrap, .alpha = 1});
  EXPECT_NEAR(volume_of(repaired.mesh) / volume_of(ball), 1, 0.02);
}

}  // namespace
}  // namespace affskel::core
