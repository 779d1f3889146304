#include "derive/solid_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/shapes/implicit_mesh.h"
#include "core/shapes/shapes.h"
#include "core/text/off_file.h"
#include "derive/derived.h"
#include "sample_job.h"

namespace affskel::worker {
namespace {

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
  EXPECT_FALSE(
      solid.curve().quality().has_hausdorff_there());  // what it is compared to takes time, and nobody asks
  double greatest = 0;
  for (const core::FieldValue& value : unpack_field(field, prepared.lattice().points))
    greatest = std::max(greatest, value.erosion);
  EXPECT_EQ(solid.greatest_erosion(), greatest);
}

// Of the many points of a plate that have the greatest E.
TEST(DeriveParts, TellTheMiddleAsThePlaceOfTheGreatestE) {
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(0.26);
  const PreparedJob prepared(core::write_off(core::make_box(20, 20, 1)), params);
  const v1::SolidParts solid = parts_of(prepared, finished_field(prepared));
  const core::Vec3 centre = prepared.solid().centre;
  EXPECT_NEAR(solid.greatest_place(0), centre.x, 0.26);
  EXPECT_NEAR(solid.greatest_place(1), centre.y, 0.26);
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
    const auto& [to, other] = std::pair(part.to(), solid.parts(static_cast<int>(part.angle_to()) - 1).to());
    EXPECT_EQ(part.angle() > 135, to[0] * other[0] + to[1] * other[1] + to[2] * other[2] < -1)
        << part.angle_to();
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

// A membrane round a cavity has no limb, and a line that went round it would be none.
TEST(DeriveParts, OfAShellIsAPointAndItSaysWhy) {
  core::Mesh shell = core::make_sphere(1, 320);
  const auto inner = static_cast<std::uint32_t>(shell.points.size());
  const std::size_t outer = shell.triangles.size();
  for (std::uint32_t v = 0; v < inner; ++v) shell.points.push_back(0.8 * shell.points[v]);
  for (std::size_t t = 0; t < outer; ++t) {
    const auto [a, b, c] = shell.triangles[t];
    shell.triangles.push_back({a + inner, c + inner, b + inner});
  }
  v1::ErosionParams params = sample_params();
  params.mutable_sampling()->set_spacing(0.07);
  const PreparedJob prepared(core::write_off(shell), params);
  const v1::SolidParts solid = parts_of(prepared, finished_field(prepared));
  ASSERT_EQ(solid.parts_size(), 1);
  EXPECT_EQ(solid.parts(0).kind(), v1::PART_KIND_POINT);
  EXPECT_EQ(solid.curve().quality().opened(), 1U);
  EXPECT_NE(solid.curve().quality().advice().find("membrane round a cavity"), std::string::npos);
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

}  // namespace
}  // namespace affskel::worker
