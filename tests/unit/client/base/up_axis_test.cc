#include "client/base/up_axis.h"

#include <gtest/gtest.h>

#include "core/shapes/body.h"
#include "core/shapes/shapes.h"

namespace affskel::client {
namespace {

using core::Mesh;
using core::Vec3;

template <typename Map>
Mesh mapped(Mesh mesh, const Map& map) {
  for (Vec3& p : mesh.points) p = map(p);
  return mesh;
}

// From z up to y up: a turn about x.
Mesh turned(const Mesh& mesh) {
  return mapped(mesh, [](const Vec3& p) { return Vec3{p.x, p.z, -p.y}; });
}

TEST(UpAxis, BodiesStand) {
  const Mesh body = core::make_body();
  EXPECT_EQ(up_axis(body), UpAxis::kZ);
  EXPECT_EQ(up_axis(turned(body)), UpAxis::kY);
  // As wide as high: only that it is even left and right, but not up and down, tells.
  const Mesh spread = mapped(body, [](const Vec3& p) { return Vec3{2.2 * p.x, 0.7 * p.y, p.z}; });
  EXPECT_EQ(up_axis(spread), UpAxis::kZ);
  EXPECT_EQ(up_axis(turned(spread)), UpAxis::kY);
}

TEST(UpAxis, IsZWhereTheShapeDoesNotTell) {
  EXPECT_EQ(up_axis(core::make_box(1, 1, 1)), UpAxis::kZ);
  EXPECT_EQ(up_axis(core::make_box(12, 12, 4)), UpAxis::kZ);
  EXPECT_EQ(up_axis(core::make_box(3, 1, 1)), UpAxis::kZ);
  EXPECT_EQ(up_axis(core::make_box(1, 1.2, 1)), UpAxis::kZ) << "hardly longer";
  EXPECT_EQ(up_axis(core::make_box(1, 1.3, 1)), UpAxis::kY);
}

TEST(UpAxis, DoesNotDependOnTheSenseOfTheFaces) {
  Mesh body = turned(mapped(core::make_body(), [](const Vec3& p) {
    return Vec3{2.2 * p.x, 0.7 * p.y, p.z};
  }));
  for (core::Triangle& t : body.triangles) std::swap(t[1], t[2]);
  EXPECT_EQ(up_axis(body), UpAxis::kY);
}

TEST(Stance, IsRightHandedWithTheAxisUp) {
  for (const UpAxis up : {UpAxis::kX, UpAxis::kY, UpAxis::kZ}) {
    const Stance s = stance(up);
    EXPECT_EQ(core::dot(core::cross(s.right, s.up), s.front), 1);
    const Vec3 axis{up == UpAxis::kX ? 1. : 0., up == UpAxis::kY ? 1. : 0., up == UpAxis::kZ ? 1. : 0.};
    EXPECT_EQ(core::dot(s.up, axis), 1) << up_letter(up);
  }
}

}  // namespace
}  // namespace affskel::client
