#include "derive/derive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>

#include "core/mesh/map_mesh.h"
#include "core/shapes/implicit_mesh.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/stopping_context.h"
#include "core/text/off_file.h"
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

TEST(DeriveRidge, OfATorusIsItsAnnulus) {
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(0.5 * params.sampling().spacing());
  const PreparedJob prepared(sample_mesh(), params);
  const std::string field = finished_field(prepared);
  v1::Lease of_points = lease_of(v1::TASK_KIND_SKELETON);
  of_points.mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  const auto points = parsed<v1::SkeletonPoints>(derive(of_points, prepared, field));
  ASSERT_GT(points.point_size(), 20);
  EXPECT_EQ(points.quality().threshold(), 6);
  EXPECT_EQ(points.quality().inside_share(), 1);
  EXPECT_EQ(points.quality().components(), 1U);
  EXPECT_EQ(points.quality().holes(), 1U);
  EXPECT_EQ(points.quality().lattice().components(), 1U);
  EXPECT_EQ(points.quality().lattice().holes(), 1U);
  EXPECT_EQ(points.quality().fragments(), 0U);
  EXPECT_EQ(points.quality().limbs(), 0U);
  EXPECT_EQ(points.quality().unreached_ends(), 0U);
  EXPECT_EQ(points.quality().tunnels_size(), 0) << "the solid has the lattice's";
  EXPECT_FALSE(points.quality().has_bridges());
  v1::Lease lease = lease_of(v1::TASK_KIND_SURFACE);
  lease.mutable_surface()->mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  const v1::TriangleMesh sheet = parsed<v1::TriangleMesh>(derive(lease, prepared, field));
  const int vertices = sheet.xyz_size() / 3;
  ASSERT_EQ(vertices, points.point_size()) << "the sheet's vertices are the skeleton's points";
  ASSERT_EQ(sheet.normal_a_size(), 3 * vertices);
  ASSERT_EQ(sheet.normal_b_size(), 3 * vertices);
  ASSERT_EQ(sheet.erosion_size(), vertices);
  ASSERT_EQ(sheet.strength_size(), vertices);
  ASSERT_EQ(sheet.ratio_size(), vertices);
  ASSERT_EQ(sheet.kind_size(), vertices);
  ASSERT_EQ(sheet.area_size(), vertices);
  const double spacing = prepared.lattice().spacing;
  int on_ridge = 0;
  for (int v = 0; v < vertices; ++v) {
    EXPECT_EQ(sheet.xyz(3 * v), points.xyz(3 * v));
    EXPECT_LT(std::abs(sheet.xyz(3 * v + 2)), 0.1 * spacing);
    EXPECT_LE(sheet.ratio(v), 1);
    EXPECT_LE(sheet.kind(v), 3U);
    if (sheet.kind(v) <= 1) {
      ++on_ridge;
      EXPECT_GE(sheet.strength(v), 6 - 1e-9);
      // The level surfaces mirror each other in the plane z = 0.
      EXPECT_LT(sheet.normal_a(3 * v + 2) * sheet.normal_b(3 * v + 2), 0);
    }
    EXPECT_EQ(sheet.erosion(v), points.erosion(v));
  }
  EXPECT_GT(on_ridge, vertices / 2);
}

// A box of side 400 with a needle of 600 on top, thinner than the spacing and between the lattice's lines.
TEST(DeriveRidge, NamesTheEndsThatTheLatticeIsTooCoarseFor) {
  core::Mesh mesh = core::make_box(400, 400, 400);
  const core::Mesh needle = core::make_box(4, 4, 700);
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  for (const core::Vec3& p : needle.points) mesh.points.push_back(p + core::Vec3{183, 213, 300});
  for (const core::Triangle& t : needle.triangles)
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(50);
  const PreparedJob prepared(core::write_off(mesh), params);
  v1::Lease lease = lease_of(v1::TASK_KIND_SKELETON);
  lease.mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  const v1::SkeletonQuality quality =
      parsed<v1::SkeletonPoints>(derive(lease, prepared, finished_field(prepared))).quality();
  EXPECT_EQ(quality.unreached_ends(), 1U);
  ASSERT_EQ(quality.unreached_size(), 1);
  EXPECT_EQ(quality.unreached(0).z(), 1000);
  EXPECT_GT(quality.unreached(0).size(), 600);
  EXPECT_LT(quality.unreached(0).size(), 900);
  EXPECT_EQ(quality.tunnels_size(), 0);
}

// One line round, whose quality tells of the curve and of the lattice.
TEST(DeriveCurve, OfATorusIsItsCircle) {
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(0.5 * params.sampling().spacing());
  const PreparedJob prepared(sample_mesh(), params);
  const std::string field = finished_field(prepared);
  v1::Lease of_points = lease_of(v1::TASK_KIND_SKELETON);
  of_points.mutable_skeleton()->set_operator_(v1::OPERATOR_CURVE);
  const auto points = parsed<v1::SkeletonPoints>(derive(of_points, prepared, field));
  const v1::SkeletonQuality& quality = points.quality();
  EXPECT_EQ(quality.threshold(), 0.9);
  EXPECT_EQ(quality.components(), 1U);
  EXPECT_EQ(quality.holes(), 1U);
  EXPECT_EQ(quality.lattice().holes(), 1U);
  EXPECT_EQ(quality.branches(), 1U);
  EXPECT_EQ(quality.ends(), 0U);
  EXPECT_EQ(quality.opened(), 0U);
  EXPECT_EQ(quality.inside_share(), 1);
  v1::Lease lease = lease_of(v1::TASK_KIND_SURFACE);
  lease.mutable_surface()->mutable_skeleton()->set_operator_(v1::OPERATOR_CURVE);
  const v1::TriangleMesh lines = parsed<v1::TriangleMesh>(derive(lease, prepared, field));
  const int vertices = lines.xyz_size() / 3;
  ASSERT_EQ(vertices, points.point_size());
  EXPECT_EQ(lines.corners_size(), 0);
  EXPECT_EQ(lines.segments_size(), 2 * vertices) << "a loop";
  ASSERT_EQ(lines.erosion_size(), vertices);
  ASSERT_EQ(lines.area_size(), vertices);
  ASSERT_EQ(lines.distance_size(), vertices);
  ASSERT_EQ(lines.beyond_size(), vertices);
  for (int v = 0; v < vertices; ++v) {
    EXPECT_LT(std::abs(lines.xyz(3 * v + 2)), 0.1 * prepared.lattice().spacing);
    EXPECT_GT(lines.distance(v), 2 * prepared.lattice().spacing);
    EXPECT_LT(lines.beyond(v), 0.1);
    EXPECT_GT(lines.erosion(v), 0);
  }
}

v1::SolidParts parts_of(const PreparedJob& prepared, const std::string& field, double threshold = 0,
                        unsigned threads = 1) {
  v1::Lease lease = lease_of(v1::TASK_KIND_PARTS);
  lease.mutable_skeleton()->set_operator_(v1::OPERATOR_CURVE);
  lease.mutable_skeleton()->set_threshold(threshold);
  return parsed<v1::SolidParts>(derive(lease, prepared, field, nullptr, threads));
}

// One loop: all of the volume and of the surface; everywhere as thick as its tube.
TEST(DeriveParts, OfATorusIsOne) {
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(0.5 * params.sampling().spacing());
  const PreparedJob prepared(sample_mesh(), params);
  const std::string field = finished_field(prepared);
  const v1::SolidParts solid = parts_of(prepared, field);
  ASSERT_EQ(solid.parts_size(), 1);
  const v1::SolidPart& part = solid.parts(0);
  EXPECT_EQ(part.kind(), v1::PART_KIND_LOOP);
  EXPECT_FALSE(part.has_angle());
  EXPECT_NEAR(part.volume(), prepared.solid().volume, 1e-9 * prepared.solid().volume);
  EXPECT_NEAR(part.surface_area(), solid.surface_area(), 1e-9 * solid.surface_area());
  const auto& xyz = solid.surface().xyz();
  double low = xyz[2], high = xyz[2];
  for (int v = 2; v < xyz.size(); v += 3) low = std::min(low, xyz[v]), high = std::max(high, xyz[v]);
  const double tube = 0.5 * (high - low);
  for (const double thickness : solid.thickness()) {
    EXPECT_GT(thickness, 0.25 * tube);  // the skeleton is an annulus
    EXPECT_LT(thickness, 1.6 * tube);
  }
  EXPECT_EQ(solid.point_part_size(), static_cast<int>(prepared.lattice().points));
  EXPECT_EQ(parts_of(prepared, field, 0, 3).SerializeAsString(), solid.SerializeAsString());
  double greatest = 0;
  for (const core::FieldValue& value : unpack_field(field, prepared.lattice().points))
    greatest = std::max(greatest, value.erosion);
  EXPECT_EQ(solid.greatest_erosion(), greatest);
}

// Three bars that cross at right angles in their middle: six limbs of the same length, and a heavy middle.
TEST(DeriveParts, OfACrossAreItsArms) {
  const double arm = 10, half = 1.25;
  const core::ImplicitFunction cross = [&](const core::Vec3& p) {
    double least = 1e300;
    const double reach[] = {arm, 0.9 * arm, 0.8 * arm};
    for (int axis = 0; axis < 3; ++axis) {
      const double along = std::clamp(p[axis], -reach[axis], reach[axis]);
      const core::Vec3 foot{axis == 0 ? along : 0, axis == 1 ? along : 0, axis == 2 ? along : 0};
      least = std::min(least, core::norm(p - foot) - half);
    }
    return least;
  };
  const core::Mesh mesh =
      core::mesh_zero_set(cross, {.low = {-12, -12, -12}, .high = {12, 12, 12}, .spacing = 0.5});
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(0.3);
  params.set_directions("sphere:320");
  const PreparedJob prepared(core::write_off(mesh), params);
  const std::string field = finished_field(prepared);
  const v1::SolidParts solid = parts_of(prepared, field);
  double volume = 0, area = 0;
  std::vector<double> limbs;
  for (const v1::SolidPart& part : solid.parts()) {
    volume += part.volume();
    area += part.surface_area();
    if (part.length() < 2) continue;  // between the joints of the middle
    limbs.push_back(part.length());
    EXPECT_EQ(part.kind(), v1::PART_KIND_LIMB);
    EXPECT_NEAR(part.straight_length(), part.length(), 0.3);
    EXPECT_NEAR(part.mean_radius(), half, 0.15);
    EXPECT_TRUE(std::abs(part.angle() - 90) < 2 || std::abs(part.angle() - 180) < 2) << part.angle();
  }
  EXPECT_NEAR(volume, prepared.solid().volume, 1e-9 * volume);
  EXPECT_NEAR(area, solid.surface_area(), 1e-9 * area);
  ASSERT_EQ(limbs.size(), 6U);
  std::sort(limbs.begin(), limbs.end());
  for (std::size_t n = 0; n < 6; ++n)
    EXPECT_NEAR(limbs[n], (0.8 + 0.1 * static_cast<double>(n / 2)) * arm, 0.6);
  // A triangle belongs to the limb that it lies on: it is as far out as that limb's end, along its axis.
  for (int t = 0; t < solid.triangle_part_size(); ++t) {
    core::Vec3 at;
    for (int k = 0; k < 3; ++k) {
      const int v = static_cast<int>(solid.surface().corners(3 * t + k));
      at = at + (1.0 / 3) * core::Vec3{solid.surface().xyz(3 * v), solid.surface().xyz(3 * v + 1),
                                       solid.surface().xyz(3 * v + 2)};
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(at[axis]) < 2.5) continue;
      const auto& to = solid.parts(static_cast<int>(solid.triangle_part(t)) - 1).to();
      EXPECT_GT(to[axis] * at[axis], 0) << t;
      EXPECT_NEAR(solid.thickness(t), half, std::abs(at[axis]) < 7 ? 0.35 : 2)
          << at.x << " " << at.y << " " << at.z;
    }
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

// A cube about one sample point.
TEST(DeriveParts, OfOnePointIsAPoint) {
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(1.2);
  const PreparedJob prepared(core::write_off(core::make_box(1, 1, 1)), params);
  ASSERT_EQ(prepared.lattice().points, 1U);
  const v1::SolidParts solid = parts_of(prepared, finished_field(prepared));
  ASSERT_EQ(solid.parts_size(), 1);
  EXPECT_EQ(solid.parts(0).kind(), v1::PART_KIND_POINT);
  EXPECT_EQ(solid.parts(0).volume_share(), 1);
  EXPECT_NEAR(solid.parts(0).surface_area(), 6, 1e-9);
}

TEST_F(DeriveTest, ASheetHasBarriersWhereTheyAreAskedFor) {
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
    EXPECT_GT(*std::ranges::max_element(sheet.barrier()), 0);
    sheet.clear_barrier();
    EXPECT_EQ(sheet.SerializeAsString(), plain.SerializeAsString()) << "nothing else changes";
  }
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
                                           InFrame{v1::FRAME_PCA, v1::OPERATOR_RIDGE, 0}),
                         [](const auto& each) {
                           return v1::Frame_Name(each.param.frame) + "_" +
                                  v1::Operator_Name(each.param.which);
                         });

}  // namespace
}  // namespace affskel::worker
