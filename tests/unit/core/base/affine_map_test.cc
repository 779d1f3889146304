#include "core/base/affine_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/mesh/map_mesh.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"

namespace affskel::core {
namespace {

AffineMap sample_map() {
  AffineMap map = then(rotation(0, 30), scaling(2, 1, 0.5));
  map = then(map, shear(1, 2, 0.75));
  return then(map, translation({5, -7, 11}));
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_NEAR(norm(a - b), 0, tolerance);
}

TEST(AffineMapTest, ElementaryMapsDoWhatTheyAreCalled) {
  EXPECT_EQ(scaling(2, 3, 4)({1, 1, 1}), (Vec3{2, 3, 4}));
  EXPECT_EQ(translation({1, 2, 3})({1, 1, 1}), (Vec3{2, 3, 4}));
  EXPECT_EQ(rotation(0, 90)({0, 1, 0}), (Vec3{0, 0, 1}));
  EXPECT_EQ(rotation(1, 90)({0, 0, 1}), (Vec3{1, 0, 0}));
  EXPECT_EQ(rotation(2, 90)({1, 0, 0}), (Vec3{0, 1, 0}));
  EXPECT_EQ(shear(1, 2, 0.5)({1, 2, 4}), (Vec3{1, 4, 4}));
}

TEST(AffineMapTest, StepsFollowEachOther) {
  const AffineMap both = then(translation({1, 0, 0}), scaling(2, 2, 2));
  EXPECT_EQ(both({1, 1, 1}), (Vec3{4, 2, 2}));
  EXPECT_EQ(then(scaling(2, 2, 2), translation({1, 0, 0}))({1, 1, 1}), (Vec3{3, 2, 2}));
}

TEST(AffineMapTest, TheInverseUndoes) {
  const AffineMap map = sample_map(), back = inverse(map);
  for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{1, 2, 3}, Vec3{-40, 0.1, 7}}) {
    expect_near(back(map(p)), p, 1e-13);
  }
  EXPECT_NEAR(determinant(map) * determinant(back), 1, 1e-14);
  EXPECT_EQ(inverse(shear(1, 2, 3)).rows, shear(1, 2, -3).rows);
  // Far from 1 the cube of the unit would overflow.
  expect_near(inverse(scaling(1e100, 1e100, 1e100))({3e100, 0, 0}), {3, 0, 0}, 1e-14);
}

TEST(AffineMapTest, SingularMapsAreKnown) {
  EXPECT_TRUE(is_singular(scaling(1, 0, 1)));
  AffineMap map;
  map.rows = {Vec3{1, 2, 3}, Vec3{4, 5, 6}, Vec3{7, 8, 9}};
  EXPECT_TRUE(is_singular(map));
  map.rows = {Vec3{0.1, 0.2, 0.3}, Vec3{0.4, 0.5, 0.6}, Vec3{0.7, 0.8, 0.9}};  // singular but for rounding
  EXPECT_TRUE(is_singular(map));
  EXPECT_TRUE(is_singular(scaling(1, 1, std::numeric_limits<double>::quiet_NaN())));
  EXPECT_TRUE(is_singular(translation({std::numeric_limits<double>::infinity(), 0, 0})));
  EXPECT_FALSE(is_singular(scaling(1e-9, 1e-9, 1e-9)));
  EXPECT_FALSE(is_singular(scaling(1e6, 1, 1e-6)));
  EXPECT_THROW(inverse(scaling(0, 1, 1)), CoreError);
  EXPECT_THROW(NormalMap(scaling(0, 1, 1)), CoreError);
  EXPECT_THROW(map_mesh(scaling(0, 1, 1), make_box(1, 1, 1)), CoreError);
}

TEST(AffineMapTest, NormalsStayNormalToTheMappedPlaneAndOnItsSide) {
  for (const AffineMap& map : {sample_map(), then(sample_map(), scaling(-1, 1, 1))}) {
    const NormalMap normals(map);
    const Vec3 n = {0.6, 0, 0.8}, along = {0.8, 0, -0.6}, other = {0, 1, 0};
    const Vec3 mapped = normals(n);
    EXPECT_NEAR(norm(mapped), 1, 1e-15);
    const Vec3 origin = map({0, 0, 0});
    EXPECT_NEAR(dot(mapped, map(along) - origin), 0, 1e-14);
    EXPECT_NEAR(dot(mapped, map(other) - origin), 0, 1e-14);
    EXPECT_GT(dot(mapped, map(n) - origin), 0);
  }
}

TEST(AffineMapTest, NormalsOfTheIdentityAndZeroStay) {
  const Vec3 n = {1.0 / 3, 1.0 / 7, 0.9};
  EXPECT_EQ(NormalMap(translation({4, 5, 6}))(n), n);
  EXPECT_EQ(NormalMap(sample_map())({0, 0, 0}), (Vec3{0, 0, 0}));
}

TEST(AffineMapTest, VolumesGrowByTheDeterminant) {
  const Mesh box = make_box(3, 2, 1);
  for (const AffineMap& map : {sample_map(), then(sample_map(), scaling(1, 1, -1))}) {
    const Solid solid = make_solid(map_mesh(map, box));
    EXPECT_NEAR(solid.volume, 6 * std::abs(determinant(map)), 1e-12);
    // A surface that points inward would have been turned, and a note would say so.
    EXPECT_TRUE(solid.notes.empty());
  }
}

TEST(AffineMapTest, CoordinatesThatOverflowAreRefused) {
  const Mesh far{{{1e300, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}};
  EXPECT_THROW(map_mesh(scaling(1e10, 1, 1), far), CoreError);
}

}  // namespace
}  // namespace affskel::core
