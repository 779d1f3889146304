#include "derive/derive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/affine_map.h"
#include "core/mesh_io.h"
#include "core/shapes.h"
#include "core/solid.h"
#include "sample_job.h"

namespace affskel::worker {
namespace {

v1::Lease lease_of(v1::TaskKind kind) {
  return other_lease("t", kind);
}

template <typename Message>
Message parsed(const Derived& derived) {
  Message message;
  EXPECT_TRUE(message.ParseFromString(derived.data));
  return message;
}

class DeriveTest : public ::testing::Test {
 protected:
  explicit DeriveTest(const std::string& mesh = sample_mesh(), v1::ErosionParams params = sample_params())
      : prepared_(mesh, params), field_(finished_field(prepared_)) {}

  Derived run(const v1::Lease& lease) { return derive(lease, prepared_, field_); }

  v1::SkeletonPoints skeleton(v1::Operator which, double threshold = 0) {
    v1::Lease lease = lease_of(v1::TASK_KIND_SKELETON);
    lease.mutable_skeleton()->set_operator_(which);
    lease.mutable_skeleton()->set_threshold(threshold);
    return parsed<v1::SkeletonPoints>(run(lease));
  }

  PreparedJob prepared_;
  std::string field_;
};

TEST_F(DeriveTest, DivergenceAndSkeletonAgree) {
  for (const v1::Operator which : {v1::OPERATOR_ZUCKER_HUMMEL, v1::OPERATOR_INTERMEDIATE,
                                   v1::OPERATOR_CENTRAL, v1::OPERATOR_SOBEL, v1::OPERATOR_FLUX}) {
    v1::Lease lease = lease_of(v1::TASK_KIND_DIVERGENCE);
    lease.mutable_skeleton()->set_operator_(which);
    const Derived divergence = run(lease);
    ASSERT_EQ(divergence.data.size(), 8U * prepared_.lattice().points);
    EXPECT_EQ(divergence.items, prepared_.lattice().points);
    const v1::SkeletonPoints points = skeleton(which);
    ASSERT_GT(points.point_size(), 20) << which;
    double least = 1e300;
    for (int i = 0; i < points.point_size(); ++i) {
      double value = 0;
      std::memcpy(&value, divergence.data.data() + 8U * points.point(i), 8);
      EXPECT_EQ(value, points.divergence(i));
      least = std::min(least, std::abs(value));
    }
    EXPECT_EQ(skeleton(which, 0.999 * least).point_size(), points.point_size()) << "nothing in between";
    EXPECT_EQ(points.quality().points(), static_cast<std::uint64_t>(points.point_size()));
    EXPECT_EQ(points.quality().inside_share(), 1);
    EXPECT_EQ(points.quality().solid_genus(), 1);
  }
}

TEST_F(DeriveTest, ChordsGiveTheTorusItsAnnulus) {
  const v1::SkeletonPoints points = skeleton(v1::OPERATOR_CHORDS);
  ASSERT_GT(points.point_size(), 20);
  for (int i = 0; i < points.point_size(); ++i) EXPECT_LT(std::abs(points.xyz(3 * i + 2)), 25);
  EXPECT_EQ(points.quality().inside_share(), 1);
  EXPECT_EQ(points.quality().components(), 1U);
  EXPECT_EQ(points.quality().holes(), 1U);
  v1::Lease lease = lease_of(v1::TASK_KIND_SURFACE);
  lease.mutable_surface()->mutable_skeleton()->set_operator_(v1::OPERATOR_CHORDS);
  const v1::TriangleMesh sheet = parsed<v1::TriangleMesh>(run(lease));
  const int vertices = sheet.xyz_size() / 3;
  EXPECT_EQ(sheet.corners_size() / 3, 2 * points.point_size());
  ASSERT_EQ(sheet.normal_a_size(), 3 * vertices);
  ASSERT_EQ(sheet.normal_b_size(), 3 * vertices);
  ASSERT_EQ(sheet.erosion_size(), vertices);
  ASSERT_EQ(sheet.strength_size(), vertices);
  ASSERT_EQ(sheet.area_size(), vertices);
  for (int v = 0; v < vertices; ++v) {
    EXPECT_LT(std::abs(sheet.xyz(3 * v + 2)), 25);
    EXPECT_GT(sheet.erosion(v), 0);
    // Two chords that mirror each other in the plane z = 0.
    EXPECT_LT(sheet.normal_a(3 * v + 2) * sheet.normal_b(3 * v + 2), 0);
  }
}

TEST_F(DeriveTest, ErodedSolidsHoldWhatTheLevelSays) {
  v1::Lease lease = lease_of(v1::TASK_KIND_ERODED_POINTS);
  lease.mutable_eroded()->set_fraction(0.02);
  const double level = 0.02 * prepared_.solid().volume;
  const v1::SkeletonPoints points = parsed<v1::SkeletonPoints>(run(lease));
  const std::vector<core::FieldValue> values = unpack_field(field_, prepared_.lattice().points);
  int above = 0;
  for (const core::FieldValue& value : values) above += value.erosion >= level;
  ASSERT_EQ(points.point_size(), above);
  for (double erosion : points.erosion()) EXPECT_GE(erosion, level);
  EXPECT_EQ(points.divergence_size(), 0);

  lease.set_kind(v1::TASK_KIND_ERODED_SURFACE);
  lease.mutable_eroded()->set_volume(level);
  const v1::TriangleMesh surface = parsed<v1::TriangleMesh>(run(lease));
  core::Mesh mesh;
  for (int v = 0; v < surface.xyz_size(); v += 3)
    mesh.points.push_back({surface.xyz(v), surface.xyz(v + 1), surface.xyz(v + 2)});
  for (int t = 0; t < surface.corners_size(); t += 3)
    mesh.triangles.push_back({surface.corners(t), surface.corners(t + 1), surface.corners(t + 2)});
  EXPECT_NEAR(core::make_solid(mesh).volume, surface.volume(), 1e-9 * surface.volume()) << "closed, outward";
  const double voxels = above * std::pow(prepared_.lattice().spacing, 3);
  EXPECT_NEAR(surface.volume(), voxels, 0.2 * voxels);
}

TEST_F(DeriveTest, EmptySkeletonsSayWhy) {
  const v1::SkeletonPoints points = skeleton(v1::OPERATOR_ZUCKER_HUMMEL, 1000);
  EXPECT_EQ(points.point_size(), 0);
  EXPECT_FALSE(points.quality().advice().empty());
}

std::string sheared_torus() {
  return core::write_off(core::map_mesh(core::shear(2, 1, 0.5), core::make_torus(6000, 2000, 256)));
}

v1::ErosionParams affine_params() {
  v1::ErosionParams params = sample_params();
  params.set_frame(v1::FRAME_AFFINE);
  return params;
}

class ShearedTest : public DeriveTest {
 protected:
  ShearedTest() : DeriveTest(sheared_torus(), affine_params()) {}

  // Above the image of the torus's plane.
  static double height(double y, double z) { return z - 0.5 * y; }
};

TEST_F(ShearedTest, ResultsComeBackFromTheFrame) {
  for (const v1::Operator which : {v1::OPERATOR_ZUCKER_HUMMEL, v1::OPERATOR_CHORDS}) {
    // In this frame the torus is tall and the normals jump by less.
    const double threshold = which == v1::OPERATOR_CHORDS ? 0 : 3;
    const v1::SkeletonPoints points = skeleton(which, threshold);
    ASSERT_GT(points.point_size(), 20);
    for (int i = 0; i < points.point_size(); ++i)
      EXPECT_LT(std::abs(height(points.xyz(3 * i + 1), points.xyz(3 * i + 2))), 700);
    EXPECT_EQ(points.quality().inside_share(), 1);
    v1::Lease lease = lease_of(v1::TASK_KIND_SURFACE);
    lease.mutable_surface()->mutable_skeleton()->set_operator_(which);
    lease.mutable_surface()->mutable_skeleton()->set_threshold(threshold);
    const v1::TriangleMesh surface = parsed<v1::TriangleMesh>(run(lease));
    ASSERT_GT(surface.corners_size(), 60);
    for (int v = 0; v < surface.xyz_size(); v += 3)
      EXPECT_LT(std::abs(height(surface.xyz(v + 1), surface.xyz(v + 2))), 700);
  }
}

}  // namespace
}  // namespace affskel::worker
