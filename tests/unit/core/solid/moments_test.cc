#include "core/solid/moments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/symmetric_eigen.h"
#include "core/shapes/shapes.h"
#include "core/solid/kurtosis.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

void expect_near(const Matrix3& a, const Matrix3& b, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[i][k], b[i][k], tolerance) << i << " " << k;
  }
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << k;
}

// No two axes, signs or shears are alike: what a wrong index would mix up.
const Matrix3 kMap = {Vec3{1.1, 0.3, -0.2}, Vec3{-0.4, 0.8, 0.5}, Vec3{0.25, -0.15, 1.3}};

Mesh mapped(Mesh mesh, const Matrix3& map, const Vec3& shift) {
  for (Vec3& p : mesh.points) p = map * p + shift;
  return mesh;
}

Matrix3 transposed(const Matrix3& m) {
  return {Vec3{m[0].x, m[1].x, m[2].x}, Vec3{m[0].y, m[1].y, m[2].y}, Vec3{m[0].z, m[1].z, m[2].z}};
}

// E[|w|^2 w w^T].
Matrix3 contracted(const FourthMoments& m) {
  Matrix3 sum{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t l = 0; l < 3; ++l)
      sum[i] = sum[i] + Vec3{m[i][0][l][int(l)], m[i][1][l][int(l)], m[i][2][l][int(l)]};
  }
  return sum;
}

// The corner tetrahedron x, y, z >= 0, x + y + z <= 1.
Mesh corner() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

TEST(SolidMoments, OfABox) {
  const Moments m = solid_moments(make_box(3, 2, 1, 2));
  EXPECT_NEAR(m.volume, 6, 1e-14);
  expect_near(m.centroid, {1.5, 1, 0.5}, 1e-15);
  expect_near(m.covariance, {Vec3{9.0 / 12, 0, 0}, Vec3{0, 4.0 / 12, 0}, Vec3{0, 0, 1.0 / 12}}, 1e-15);
}

// Dirichlet: E[x^a y^b z^c] = 3! a! b! c! / (3 + a + b + c)!.
TEST(SolidMoments, OfATetrahedron) {
  const Moments m = solid_moments(corner());
  EXPECT_NEAR(m.volume, 1.0 / 6, 1e-16);
  expect_near(m.centroid, {0.25, 0.25, 0.25}, 1e-16);
  const double same = 2.0 / 20 - 1.0 / 16, other = 1.0 / 20 - 1.0 / 16;
  expect_near(m.covariance, {Vec3{same, other, other}, Vec3{other, same, other}, Vec3{other, other, same}},
              1e-16);
  EXPECT_NEAR(third_moment(corner(), m.volume, {}, {1, 0, 0}), 6.0 * 6 / 720, 1e-16);
  // (x - 2 y + 3 z)^3, term by term.
  const double cubes = 6 * (1 - 8 + 27), squares = 2 * 3 * (-2 + 3 + 4 + 12 + 9 - 18), product = -6 * 6;
  EXPECT_NEAR(third_moment(corner(), m.volume, {}, {1, -2, 3}), 6 * (cubes + squares + product) / 720, 1e-15);
  // E[(x^2 + y^2 + z^2) x^2] and E[(x^2 + y^2 + z^2) x y].
  const double diagonal = 6.0 * (24 + 4 + 4) / 5040, off = 6.0 * (6 + 6 + 2) / 5040;
  expect_near(contracted(fourth_moments(corner(), m.volume, {}, kIdentity3)),
              {Vec3{diagonal, off, off}, Vec3{off, diagonal, off}, Vec3{off, off, diagonal}}, 1e-16);
}

TEST(SolidMoments, OfFourthOrderOfATetrahedron) {
  const FourthMoments m = fourth_moments(corner(), 1.0 / 6, {}, kIdentity3);
  constexpr std::array<double, 5> kFactorial = {1, 1, 2, 6, 24};
  for (std::size_t n = 0; n < 81; ++n) {
    const std::array<std::size_t, 4> index = {n / 27, n / 9 % 3, n / 3 % 3, n % 3};
    double product = 1;
    for (std::size_t c = 0; c < 3; ++c) {
      product *= kFactorial[static_cast<std::size_t>(std::count(index.begin(), index.end(), c))];
    }
    EXPECT_NEAR(m[index[0]][index[1]][index[2]][static_cast<int>(index[3])], 6 * product / 5040, 1e-17) << n;
  }
}

// E[x^2] = a^2 / 5, E[|x|^2 x^2] = (3 a^4 + a^2 b^2 + a^2 c^2) / 35; the mesh is inscribed.
TEST(SolidMoments, OfAnEllipsoid) {
  const Mesh mesh = make_ellipsoid(3, 2, 1, 40000);
  const Moments m = solid_moments(mesh);
  constexpr double kPi = 3.14159265358979323846;
  EXPECT_NEAR(m.volume / (8 * kPi), 1, 1e-3);
  expect_near(m.centroid, {}, 1e-14);
  expect_near(m.covariance, {Vec3{9.0 / 5, 0, 0}, Vec3{0, 4.0 / 5, 0}, Vec3{0, 0, 1.0 / 5}}, 2e-3);
  const Matrix3 fourth = contracted(fourth_moments(mesh, m.volume, {}, kIdentity3));
  expect_near(fourth, {Vec3{288.0 / 35, 0, 0}, Vec3{0, 88.0 / 35, 0}, Vec3{0, 0, 16.0 / 35}}, 2e-2);
}

TEST(SolidMoments, GoAlongWithAnAffineMap) {
  for (const Mesh& mesh : {corner(), cup(9), make_cone(1, 2, 7), hollow_ball()}) {
    const Mesh image = mapped(mesh, kMap, {5, -7, 3});
    const Moments before = solid_moments(mesh), after = solid_moments(image);
    EXPECT_NEAR(after.volume, determinant(kMap) * before.volume, 1e-13 * before.volume);
    expect_near(after.centroid, kMap * before.centroid + Vec3{5, -7, 3}, 1e-13);
    expect_near(after.covariance, kMap * before.covariance * transposed(kMap), 1e-13);
    const Vec3 axis{0.3, -1.2, 0.7};
    EXPECT_NEAR(third_moment(image, after.volume, after.centroid, axis),
                third_moment(mesh, before.volume, before.centroid, transposed(kMap) * axis), 1e-12);
    const FourthMoments fourth = fourth_moments(image, after.volume, after.centroid, kIdentity3);
    const FourthMoments of_map = fourth_moments(mesh, before.volume, before.centroid, kMap);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) expect_near(fourth[i][j], of_map[i][j], 1e-10);
    }
    const FourthMoments plain = fourth_moments(mesh, before.volume, before.centroid, kIdentity3);
    EXPECT_NEAR(kurtosis_along(fourth, axis), kurtosis_along(plain, transposed(kMap) * axis), 1e-10);
  }
}

// A ball of radius 3 at the origin without one of radius 1: integrals are sums over shells.
TEST(SolidMoments, AreAdditive) {
  const Mesh outer = make_sphere(3, 320), hole = moved(make_sphere(1, 80), {0.5, -0.25, 1});
  const Mesh whole = joined(outer, reversed(hole));
  const double a = solid_moments(outer).volume, b = -solid_moments(hole).volume;
  const Moments m = solid_moments(whole);
  EXPECT_NEAR(m.volume, a + b, 1e-12);
  expect_near(m.centroid, (b / (a + b)) * Vec3{0.5, -0.25, 1}, 1e-13);
  const auto fourth = [&](const Mesh& mesh, double volume) {
    return volume * contracted(fourth_moments(mesh, volume, m.centroid, kMap));
  };
  const Matrix3 of_outer = fourth(outer, a), of_hole = fourth(hole, -b), of_whole = fourth(whole, m.volume);
  for (std::size_t i = 0; i < 3; ++i) expect_near(of_whole[i], of_outer[i] - of_hole[i], 1e-9);
}

// Far from the origin the coordinates have few bits left, but the sums lose none of them.
TEST(SolidMoments, DoNotCancelFarFromTheOrigin) {
  const Moments m = solid_moments(moved(make_box(3, 2, 1), {0x1p30, -0x1p31, 0x1p29}));
  EXPECT_NEAR(m.volume, 6, 1e-9);
  EXPECT_NEAR(m.centroid.x - 0x1p30, 1.5, 1e-6);
  expect_near(m.covariance, {Vec3{9.0 / 12, 0, 0}, Vec3{0, 4.0 / 12, 0}, Vec3{0, 0, 1.0 / 12}}, 1e-9);
}

}  // namespace
}  // namespace affskel::core
