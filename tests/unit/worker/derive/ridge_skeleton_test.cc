#include "derive/ridge_skeleton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/shapes/implicit_mesh.h"
#include "core/shapes/shapes.h"
#include "core/text/off_file.h"
#include "derive/derived.h"
#include "derive/ridge_of_field.h"
#include "sample_job.h"

namespace affskel::worker {
namespace {

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

v1::TriangleMesh sheet_of(v1::Operator which, const PreparedJob& prepared, const std::string& field,
                          double threshold = 0) {
  v1::Lease lease = lease_of(v1::TASK_KIND_SURFACE);
  lease.mutable_surface()->mutable_skeleton()->set_operator_(which);
  lease.mutable_surface()->mutable_skeleton()->set_threshold(threshold);
  return parsed<v1::TriangleMesh>(derive(lease, prepared, field));
}

// Of a rod of radius 1 with the halves of balls about z = -4 and 4 at its ends: the curve's limbs end there.
TEST(DeriveRidge, HasLinesThatLeadToTheTips) {
  const auto rod = [](const core::Vec3& p) {
    return norm(p - core::Vec3{0, 0, std::clamp(p.z, -4.0, 4.0)}) - 1;
  };
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(0.2);
  params.set_directions("sphere:320");
  const PreparedJob prepared(
      core::write_off(core::mesh_zero_set(rod, {{-1.5, -1.5, -5.5}, {1.5, 1.5, 5.5}, 0.3})), params);
  const std::string field = finished_field(prepared);
  const auto top = [](const v1::TriangleMesh& sheet) {
    double z = 0;
    for (int k = 2; k < sheet.xyz_size(); k += 3) z = std::max(z, sheet.xyz(k));
    return z;
  };
  EXPECT_NEAR(top(sheet_of(v1::OPERATOR_RIDGE, prepared, field)), 4.5, 0.2);
  EXPECT_NEAR(top(sheet_of(v1::OPERATOR_CURVE, prepared, field)), 4, 0.2);
}

// Of a coin, by a place alone.  What a higher threshold leaves out is no plate.
TEST(DeriveCurve, SaysThatLinesTellLittleOfPlates) {
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(0.15);
  params.set_directions("sphere:320");
  const auto advice_of = [&](const core::Mesh& mesh, double threshold) {
    const PreparedJob prepared(core::write_off(mesh), params);
    return sheet_of(v1::OPERATOR_CURVE, prepared, finished_field(prepared), threshold).quality().advice();
  };
  const core::Mesh coin = core::make_cylinder(3, 0.6, 32);
  EXPECT_NE(advice_of(coin, 0).find("lines tell little of plates"), std::string::npos);
  EXPECT_EQ(advice_of(coin, 20).find("lines tell little of plates"), std::string::npos);
  EXPECT_EQ(advice_of(core::make_box(1, 1, 6), 0).find("lines tell little of plates"), std::string::npos);
}

// A ball's, where E is greatest, was two triangles without area.
TEST(DeriveRidge, OfABallIsAPoint) {
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(0.2);
  const PreparedJob prepared(core::write_off(core::make_sphere(1, 320)), params);
  const std::string field = finished_field(prepared);
  v1::Lease lease = lease_of(v1::TASK_KIND_SURFACE);
  lease.mutable_surface()->mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  const v1::TriangleMesh sheet = parsed<v1::TriangleMesh>(derive(lease, prepared, field));
  EXPECT_EQ(sheet.xyz_size(), 3);
  EXPECT_EQ(sheet.part_size(), 1);
  EXPECT_EQ(sheet.corners_size(), 0);
  EXPECT_EQ(sheet.segments_size(), 0);
  EXPECT_EQ(sheet.quality().points(), 1U);
  EXPECT_EQ(sheet.quality().components(), 1U);
  EXPECT_NE(sheet.quality().advice().find("hardly more than a point"), std::string::npos);
  lease.set_kind(v1::TASK_KIND_SKELETON);
  lease.mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  EXPECT_EQ(parsed<v1::SkeletonPoints>(derive(lease, prepared, field)).point_size(), 1);
}

// As in bars along the axes, where it is all ways.
TEST(DeriveRidge, SaysThatHardlyAnyOfItIsRidge) {
  core::RidgeSheet sheet;
  sheet.vertices.resize(20);
  for (core::SheetVertex& vertex : sheet.vertices) vertex.kind = core::SkeletonKind::kWay;
  sheet.strongest = 1.5;
  v1::SkeletonQuality quality;
  RidgeOfField::report_ridge(sheet, 6, quality);
  EXPECT_NE(quality.advice().find("none of it lies on a ridge"), std::string::npos) << quality.advice();
  ASSERT_EQ(quality.to_try_size(), 1);
  EXPECT_EQ(quality.to_try(0).value(), "0.5");
  sheet.vertices[0].kind = core::SkeletonKind::kRidge;
  sheet.vertices[1].kind = core::SkeletonKind::kCurve;
  v1::SkeletonQuality enough;
  RidgeOfField::report_ridge(sheet, 6, enough);
  EXPECT_EQ(enough.advice(), "");
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

// A box with a cavity 100 under its top.
TEST(DeriveCurve, NamesThePlaceWhereTheSheetRoundACavityIsOpened) {
  core::Mesh mesh = core::make_box(1000, 1000, 1000);
  const core::Mesh cavity = core::make_box(400, 400, 400);
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  for (const core::Vec3& p : cavity.points) mesh.points.push_back(p + core::Vec3{300, 300, 400});
  for (const core::Triangle& t : cavity.triangles)
    mesh.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(50);
  const PreparedJob prepared(core::write_off(mesh), params);
  v1::Lease lease = lease_of(v1::TASK_KIND_SKELETON);
  lease.mutable_skeleton()->set_operator_(v1::OPERATOR_CURVE);
  const v1::SkeletonQuality quality =
      parsed<v1::SkeletonPoints>(derive(lease, prepared, finished_field(prepared))).quality();
  EXPECT_EQ(quality.solid_cavities(), 1U);
  EXPECT_EQ(quality.cavities(), 0U);
  EXPECT_EQ(quality.opened(), 1U);
  ASSERT_EQ(quality.openings_size(), 1);
  EXPECT_NEAR(quality.openings(0).z(), 900, 60) << "in the middle of the thinnest wall";
  EXPECT_GT(quality.openings(0).size(), 60);
  EXPECT_LT(quality.openings(0).size(), 110);
}

// A cube with a cavity between the lattice's lines.
TEST(DeriveRidge, SaysThatTheLatticeMissesACavity) {
  core::Mesh mesh = core::make_box(400, 400, 400);
  const core::Mesh cavity = core::make_box(4, 4, 4);
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  for (const core::Vec3& p : cavity.points) mesh.points.push_back(p + core::Vec3{183, 213, 207});
  for (const auto& [a, b, c] : cavity.triangles) mesh.triangles.push_back({a + first, c + first, b + first});
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(40);
  const PreparedJob prepared(core::write_off(mesh), params);
  v1::Lease lease = lease_of(v1::TASK_KIND_SKELETON);
  lease.mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  const auto points = parsed<v1::SkeletonPoints>(derive(lease, prepared, finished_field(prepared)));
  EXPECT_EQ(points.quality().solid_cavities(), 1U);
  EXPECT_EQ(points.quality().cavities(), 0U);
  EXPECT_NE(points.quality().advice().find("the solid has 1 piece, 0 tunnels and 1 void"), std::string::npos)
      << points.quality().advice();
  ASSERT_EQ(points.quality().to_try_size(), 1);
}

}  // namespace
}  // namespace affskel::worker
