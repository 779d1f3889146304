#include "derive/derive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>

#include "core/mesh/map_mesh.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/stopping_context.h"
#include "core/text/off_file.h"
#include "derive/derived.h"
#include "sample_job.h"

namespace affskel::worker {
namespace {

class DeriveTest : public ::testing::Test {
 protected:
  DeriveTest() : prepared_(sample_mesh(), sample_params()), field_(finished_field(prepared_)) {}

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

TEST_F(DeriveTest, StopsWhereverItIsAsked) {
  for (const v1::Operator which :
       {v1::OPERATOR_ZUCKER_HUMMEL, v1::OPERATOR_CHORDS, v1::OPERATOR_RIDGE, v1::OPERATOR_CURVE}) {
    for (const v1::TaskKind kind : {v1::TASK_KIND_SKELETON, v1::TASK_KIND_SURFACE}) {
      v1::Lease lease = lease_of(kind);
      lease.mutable_skeleton()->set_operator_(which);
      lease.mutable_surface()->mutable_skeleton()->set_operator_(which);
      lease.mutable_surface()->set_barrier(which == v1::OPERATOR_CHORDS);
      core::expect_stops_wherever_it_is_asked(
          5, [&](core::ExecutionContext* context) { derive(lease, prepared_, field_, context); });
    }
  }
  const v1::Lease eroded = lease_of(v1::TASK_KIND_ERODED_SURFACE);
  core::expect_stops_wherever_it_is_asked(
      prepared_.lattice().grid.dims[0],
      [&](core::ExecutionContext* context) { derive(eroded, prepared_, field_, context); });
}

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
    EXPECT_FALSE(points.quality().has_bridges()) << "of sheets only";
  }
}

TEST_F(DeriveTest, ChordsGiveTheTorusItsAnnulus) {
  const v1::SkeletonPoints points = skeleton(v1::OPERATOR_CHORDS);
  ASSERT_GT(points.point_size(), 20);
  for (int i = 0; i < points.point_size(); ++i) EXPECT_LT(std::abs(points.xyz(3 * i + 2)), 25);
  EXPECT_EQ(points.quality().inside_share(), 1);
  EXPECT_EQ(points.quality().components(), 1U);
  EXPECT_EQ(points.quality().holes(), 1U);
  EXPECT_TRUE(points.quality().has_bridges());
  EXPECT_EQ(points.quality().advice(), "");
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

// Every sheet's vertex has the part of the sample point that it lies at, whatever the threshold.
TEST_F(DeriveTest, SheetsHaveParts) {
  const v1::SolidParts solid = parts_of(prepared_, field_);
  for (const double threshold : {0.0, 12.0}) {
    v1::Lease lease = lease_of(v1::TASK_KIND_SURFACE);
    lease.mutable_surface()->mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
    lease.mutable_surface()->mutable_skeleton()->set_threshold(threshold);
    const v1::TriangleMesh sheet = parsed<v1::TriangleMesh>(run(lease));
    ASSERT_EQ(sheet.part_size(), sheet.xyz_size() / 3);
    for (const std::uint32_t part : sheet.part()) {
      EXPECT_GE(part, 1U);
      EXPECT_LE(part, static_cast<std::uint32_t>(solid.parts_size()));
    }
  }
}

// That of `ridge` lies in the plane of symmetry, where barriers are 0; that of `chords` does not quite.
TEST_F(DeriveTest, ASheetHasBarriersWhereTheyAreAskedFor) {
  double highest = 0;
  for (const v1::Operator which : {v1::OPERATOR_CHORDS, v1::OPERATOR_RIDGE}) {
    v1::Lease lease = lease_of(v1::TASK_KIND_SURFACE);
    lease.mutable_surface()->mutable_skeleton()->set_operator_(which);
    const v1::TriangleMesh plain = parsed<v1::TriangleMesh>(run(lease));
    EXPECT_EQ(plain.barrier_size(), 0);
    lease.mutable_surface()->set_barrier(true);
    const Derived one = run(lease), many = derive(lease, prepared_, field_, nullptr, 3);
    EXPECT_EQ(one.data, many.data);
    v1::TriangleMesh sheet = parsed<v1::TriangleMesh>(one);
    ASSERT_EQ(sheet.barrier_size(), sheet.erosion_size());
    for (const double barrier : sheet.barrier()) EXPECT_GE(barrier, 0);
    highest = std::max(highest, *std::ranges::max_element(sheet.barrier()));
    sheet.clear_barrier();
    EXPECT_EQ(sheet.SerializeAsString(), plain.SerializeAsString()) << "nothing else changes";
  }
  EXPECT_GT(highest, 0);
}

TEST_F(DeriveTest, ALeastBarrierCutsTheSheet) {
  v1::Lease lease = lease_of(v1::TASK_KIND_SURFACE);
  lease.mutable_surface()->mutable_skeleton()->set_operator_(v1::OPERATOR_CHORDS);
  lease.mutable_surface()->set_barrier(true);
  const v1::TriangleMesh whole = parsed<v1::TriangleMesh>(run(lease));
  std::vector<double> sorted(whole.barrier().begin(), whole.barrier().end());
  std::ranges::sort(sorted);
  const double least = sorted[sorted.size() / 2];
  ASSERT_GT(least, 0);
  // Triangles by the places of their corners: the vertices are numbered anew.
  const auto places = [](const v1::TriangleMesh& sheet, double low) {
    std::vector<std::vector<double>> list;
    for (int t = 0; t < sheet.corners_size(); t += 3) {
      std::vector<double> triangle;
      double lowest = 1e300;
      for (int k = t; k < t + 3; ++k) {
        const int v = static_cast<int>(sheet.corners(k));
        lowest = std::min(lowest, sheet.barrier(v));
        for (const double value : {sheet.xyz(3 * v), sheet.xyz(3 * v + 1), sheet.xyz(3 * v + 2),
                                   sheet.barrier(v), sheet.strength(v), sheet.normal_b(3 * v)})
          triangle.push_back(value);
      }
      if (lowest >= low) list.push_back(triangle);
    }
    return list;
  };
  lease.mutable_surface()->set_min_barrier(least);
  const v1::TriangleMesh cut = parsed<v1::TriangleMesh>(run(lease));
  EXPECT_EQ(places(cut, 0), places(whole, least));
  EXPECT_LT(cut.corners_size(), whole.corners_size());
  EXPECT_GT(cut.corners_size(), 0);
  EXPECT_EQ(cut.quality().points(), static_cast<std::uint64_t>(cut.barrier_size())) << "none is unused";
  EXPECT_FALSE(cut.quality().has_hausdorff_there());
  lease.mutable_surface()->set_min_barrier(1e6);
  const v1::TriangleMesh empty = parsed<v1::TriangleMesh>(run(lease));
  EXPECT_EQ(empty.corners_size(), 0);
  EXPECT_EQ(empty.xyz_size(), 0);
  ASSERT_EQ(empty.quality().to_try_size(), 1) << empty.quality().advice();
  EXPECT_EQ(empty.quality().to_try(0).name(), "min_barrier");
}

// Parts are those of the whole sheet, of which nothing may be left: in the plane of symmetry barriers are 0.
TEST_F(DeriveTest, ALeastBarrierMayCutAllOfARidge) {
  v1::Lease lease = lease_of(v1::TASK_KIND_SURFACE);
  lease.mutable_surface()->mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  lease.mutable_surface()->set_barrier(true);
  lease.mutable_surface()->set_min_barrier(1e6);
  const v1::TriangleMesh empty = parsed<v1::TriangleMesh>(run(lease));
  EXPECT_EQ(empty.corners_size(), 0);
  EXPECT_EQ(empty.part_size(), empty.erosion_size());
}

TEST_F(DeriveTest, ARidgeHasNoThresholdAboveTheLast) {
  const v1::SkeletonPoints points = skeleton(v1::OPERATOR_RIDGE, 700);
  EXPECT_EQ(points.quality().threshold(), 700);
  EXPECT_EQ(points.quality().other_threshold(), 0);
  EXPECT_FALSE(points.quality().has_hausdorff_there());
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
  const std::size_t vertices = mesh.points.size();
  ASSERT_EQ(static_cast<std::size_t>(surface.erosion_size()), vertices);
  ASSERT_EQ(static_cast<std::size_t>(surface.area_size()), vertices);
  std::vector<double> erosion(surface.erosion().begin(), surface.erosion().end());
  std::nth_element(erosion.begin(), erosion.begin() + static_cast<std::ptrdiff_t>(vertices / 2),
                   erosion.end());
  EXPECT_NEAR(erosion[vertices / 2], level, 0.02 * level);
  for (const double area : surface.area()) EXPECT_GT(area, 0);
  const double voxels = above * std::pow(prepared_.lattice().spacing, 3);
  EXPECT_NEAR(surface.volume(), voxels, 0.2 * voxels);
}

TEST_F(DeriveTest, NoLevelIsAboveTheVolume) {
  v1::Lease lease = lease_of(v1::TASK_KIND_ERODED_POINTS);
  for (const v1::TaskKind kind : {v1::TASK_KIND_ERODED_POINTS, v1::TASK_KIND_ERODED_SURFACE}) {
    lease.set_kind(kind);
    lease.mutable_eroded()->set_volume(prepared_.solid().volume);
    EXPECT_THROW(run(lease), core::CoreError);
    lease.mutable_eroded()->set_volume(0.999 * prepared_.solid().volume);
    EXPECT_NO_THROW(run(lease));
  }
}

TEST_F(DeriveTest, AnAlphaShapeHasTheFieldOfItsPoints) {
  const v1::SkeletonPoints points = skeleton(v1::OPERATOR_ZUCKER_HUMMEL);
  const std::vector<core::FieldValue> values = unpack_field(field_, prepared_.lattice().points);
  std::map<std::array<double, 3>, core::FieldValue> at;
  for (int i = 0; i < points.point_size(); ++i)
    at[{points.xyz(3 * i), points.xyz(3 * i + 1), points.xyz(3 * i + 2)}] = values[points.point(i)];
  v1::Lease lease = lease_of(v1::TASK_KIND_SURFACE);
  lease.mutable_surface()->mutable_skeleton()->set_operator_(v1::OPERATOR_ZUCKER_HUMMEL);
  const v1::TriangleMesh surface = parsed<v1::TriangleMesh>(run(lease));
  ASSERT_GT(surface.xyz_size(), 60);
  ASSERT_EQ(surface.erosion_size(), surface.xyz_size() / 3);
  for (int v = 0; v < surface.erosion_size(); ++v) {
    const auto found = at.find({surface.xyz(3 * v), surface.xyz(3 * v + 1), surface.xyz(3 * v + 2)});
    ASSERT_NE(found, at.end());
    EXPECT_EQ(surface.erosion(v), found->second.erosion);
    EXPECT_NEAR(surface.area(v), found->second.area, 1e-12 * found->second.area);
  }
}

TEST_F(DeriveTest, EmptySkeletonsSayWhy) {
  const v1::SkeletonPoints points = skeleton(v1::OPERATOR_ZUCKER_HUMMEL, 1000);
  EXPECT_EQ(points.point_size(), 0);
  EXPECT_FALSE(points.quality().advice().empty());
}

// Each as if alone, and of another field the first is not given.  So many thresholds that what is known would be more than
// what is kept.
TEST_F(DeriveTest, WhatIsKnownChangesNothing) {
  std::vector<v1::Lease> leases;
  for (const double threshold : {0.0, 4.0, 6.0, 2.0, 3.0, 5.0}) {
    for (const v1::Operator which : {v1::OPERATOR_RIDGE, v1::OPERATOR_CURVE}) {
      leases.push_back(lease_of(v1::TASK_KIND_SKELETON));
      leases.back().mutable_skeleton()->set_operator_(which);
      leases.back().mutable_skeleton()->set_threshold(threshold);
      leases.push_back(leases.back());
      leases.back().set_kind(v1::TASK_KIND_SURFACE);
      *leases.back().mutable_surface()->mutable_skeleton() = leases.back().skeleton();
    }
  }
  leases.push_back(lease_of(v1::TASK_KIND_SKELETON));
  leases.back().mutable_skeleton()->set_operator_(v1::OPERATOR_CHORDS);
  leases.push_back(lease_of(v1::TASK_KIND_PARTS));
  v1::ErosionParams params = sample_params();
  params.set_directions("sphere:320");
  PreparedJob other(sample_mesh(), params);
  KnownRidges known;
  for (PreparedJob* job : {&prepared_, &other}) {
    const std::string field = finished_field(*job);
    for (v1::Lease lease : leases) {
      lease.set_field(job == &other ? "second" : "first");
      EXPECT_EQ(derive(lease, *job, field, nullptr, 1, &known).data, derive(lease, *job, field).data)
          << lease.ShortDebugString();
      EXPECT_EQ(known.basis.has_value(), lease.skeleton().operator_() != v1::OPERATOR_CHORDS);
      EXPECT_LE(known.sheets.size() + known.curves.size(), KnownRidges::kMost + 3);
    }
  }
}

struct InFrame {
  v1::Frame frame;
  v1::Operator which;
  double threshold;
};

class FrameTest : public ::testing::TestWithParam<InFrame> {};

// A torus sheared so that its plane becomes z = y / 2.
TEST_P(FrameTest, ResultsComeBackFromTheFrame) {
  v1::ErosionParams params = sample_params();
  params.set_frame(GetParam().frame);
  const core::Mesh mesh = core::map_mesh(core::shear(2, 1, 0.5), core::make_torus(6000, 2000, 256));
  const PreparedJob prepared(core::write_off(mesh), params);
  const std::string field = finished_field(prepared);
  const auto off_plane = [](const google::protobuf::RepeatedField<double>& xyz) {
    double sum = 0;
    for (int i = 0; i < xyz.size(); i += 3) sum += std::abs(xyz[i + 2] - 0.5 * xyz[i + 1]);
    return 3 * sum / xyz.size();
  };

  v1::Lease lease = lease_of(v1::TASK_KIND_SKELETON);
  lease.mutable_skeleton()->set_operator_(GetParam().which);
  lease.mutable_skeleton()->set_threshold(GetParam().threshold);
  const v1::SkeletonPoints points = parsed<v1::SkeletonPoints>(derive(lease, prepared, field));
  ASSERT_GT(points.point_size(), 20);
  EXPECT_LT(off_plane(points.xyz()), 600) << "the torus is 4000 thick";
  EXPECT_EQ(points.quality().inside_share(), 1);
  if (GetParam().which == v1::OPERATOR_CURVE) {
    EXPECT_NE(points.quality().advice().find("limbs are told in the lattice's frame"), std::string::npos);
    return;  // its lines have no triangles
  }

  *lease.mutable_surface()->mutable_skeleton() = lease.skeleton();
  lease.set_kind(v1::TASK_KIND_SURFACE);
  const v1::TriangleMesh surface = parsed<v1::TriangleMesh>(derive(lease, prepared, field));
  ASSERT_GT(surface.corners_size(), 60);
  EXPECT_LT(off_plane(surface.xyz()), 600);
}

INSTANTIATE_TEST_SUITE_P(Derive, FrameTest,
                         ::testing::Values(InFrame{v1::FRAME_AFFINE, v1::OPERATOR_ZUCKER_HUMMEL, 3},
                                           InFrame{v1::FRAME_PCA, v1::OPERATOR_ZUCKER_HUMMEL, 5},
                                           InFrame{v1::FRAME_PCA, v1::OPERATOR_CHORDS, 0},
                                           InFrame{v1::FRAME_PCA, v1::OPERATOR_RIDGE, 0},
                                           InFrame{v1::FRAME_AFFINE, v1::OPERATOR_CURVE, 0}),
                         [](const auto& each) {
                           return v1::Frame_Name(each.param.frame) + "_" +
                                  v1::Operator_Name(each.param.which);
                         });

}  // namespace
}  // namespace affskel::worker
