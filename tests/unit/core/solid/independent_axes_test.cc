#include "core/solid/independent_axes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/symmetric_eigen.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/solid/kurtosis.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

Matrix3 rotation(double s, double x, double y, double z) {
  const double n = std::sqrt(s * s + x * x + y * y + z * z);
  s /= n, x /= n, y /= n, z /= n;
  return {Vec3{1 - 2 * (y * y + z * z), 2 * (x * y + s * z), 2 * (x * z - s * y)},
          Vec3{2 * (x * y - s * z), 1 - 2 * (x * x + z * z), 2 * (y * z + s * x)},
          Vec3{2 * (x * z + s * y), 2 * (y * z - s * x), 1 - 2 * (x * x + y * y)}};
}

const Matrix3 kTurn = rotation(1, 0.4, -0.3, 0.7);

// Those of the whitened solid, turned.
FourthMoments whitened_moments(const Mesh& mesh, const Matrix3& turn = kIdentity3) {
  const Moments m = solid_moments(mesh);
  const SymmetricEigen eigen = symmetric_eigen(m.covariance);
  Matrix3 whitening{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 e = eigen.vectors[k], scaled = (1 / std::sqrt(eigen.values[k])) * e;
    whitening = {whitening[0] + e.x * scaled, whitening[1] + e.y * scaled, whitening[2] + e.z * scaled};
  }
  return fourth_moments(mesh, m.volume, m.centroid, turn * whitening);
}

double contrast(const FourthMoments& m, const Matrix3& axes) {
  double sum = 0;
  for (const Vec3& u : axes) sum += (kurtosis_along(m, u) - 3) * (kurtosis_along(m, u) - 3);
  return sum;
}

// The largest distance of an axis of `a` from the nearest of +-`b`.
double apart(const Matrix3& a, const Matrix3& b) {
  double largest = 0;
  for (const Vec3& u : a) {
    double nearest = 2;
    for (const Vec3& v : b) nearest = std::min({nearest, norm(u - v), norm(u + v)});
    largest = std::max(largest, nearest);
  }
  return largest;
}

void expect_orthonormal(const Matrix3& axes) {
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(norm(axes[k]), 1, 1e-15);
    EXPECT_NEAR(dot(axes[k], axes[(k + 1) % 3]), 0, 1e-15);
  }
}

const Mesh& body() {
  static const Mesh mesh = make_body({292, 1800});
  return mesh;
}

std::vector<Mesh> solids() {
  return {
      body(), cup(9), comb(3), make_tetrahedron(1), shaken(make_box(3, 2, 1, 3), 0.1, 5), make_cone(1, 2, 9)};
}

// Turns spread over all rotations (the R_3 sequence of Roberts in the cube of quaternions' three last parts).
TEST(IndependentAxes, NoOtherRotationHasMoreContrast) {
  for (const Mesh& mesh : solids()) {
    const FourthMoments m = whitened_moments(mesh);
    const IndependentAxes found = independent_axes(m);
    expect_orthonormal(found.axes);
    const double best = contrast(m, found.axes);
    for (std::uint32_t n = 1; n <= 5000; ++n) {
      double whole = 0;
      const double x = std::modf(n * 0.8191725133961645, &whole),
                   y = std::modf(n * 0.6710436067037893, &whole),
                   z = std::modf(n * 0.5497004779019703, &whole);
      ASSERT_LE(contrast(m, rotation(1, 2 * x - 1, 2 * y - 1, 2 * z - 1)), best * (1 + 1e-12)) << n;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(found.kurtosis[k], kurtosis_along(m, found.axes[k]), 1e-13);
    }
  }
}

// A box's coordinates are independent, and uniform: E[w^4] = 9/5.
TEST(IndependentAxes, OfABoxAreItsEdges) {
  const IndependentAxes found = independent_axes(whitened_moments(make_box(3, 2, 1, 2), kTurn));
  EXPECT_LT(apart(found.axes, kTurn), 1e-14);
  for (const double k : found.kurtosis) EXPECT_NEAR(k, 1.8, 1e-14);
}

TEST(IndependentAxes, TurnWithTheVariable) {
  for (const Mesh& mesh : {body(), comb(3), shaken(make_box(3, 2, 1, 3), 0.1, 5)}) {
    const IndependentAxes before = independent_axes(whitened_moments(mesh));
    for (const Matrix3& turn : {kTurn, rotation(0.2, 1, 0.1, 0.3), rotation(1, 0.41, 0.41, 0.41)}) {
      const IndependentAxes after = independent_axes(whitened_moments(mesh, turn));
      EXPECT_LT(apart(after.axes, turn * before.axes), 1e-12);
    }
  }
}

// Seven sides are a circle to fourth moments: the axis is found, and the coordinate axis nearest to the plane
// across it gives the other two.
TEST(IndependentAxes, OfACylinderAreItsOwnAndTheNearestCoordinateAxis) {
  const Mesh mesh = make_cylinder(1, 2, 7);
  EXPECT_LT(apart(independent_axes(whitened_moments(mesh)).axes, kIdentity3), 1e-12);
  const Vec3 own = kTurn[2];
  const std::array<double, 3> away = {std::abs(own.x), std::abs(own.y), std::abs(own.z)};
  const auto nearest = static_cast<std::size_t>(std::min_element(away.begin(), away.end()) - away.begin());
  const Vec3 across = kIdentity3[nearest] - dot(kIdentity3[nearest], own) * own;
  const Vec3 first = (1 / norm(across)) * across;
  EXPECT_LT(apart(independent_axes(whitened_moments(mesh, kTurn)).axes, {first, cross(own, first), own}),
            1e-12);
}

// What no moment tells apart gives the same axes.
TEST(IndependentAxes, DoNotDependOnATurnAboutAnAxisOfSymmetry) {
  for (const Mesh& mesh : {make_cylinder(1, 2, 7), make_cone(1, 2, 7), make_cone(3, 1, 5), cup(11)}) {
    const Matrix3 axes = independent_axes(whitened_moments(mesh, kTurn)).axes;
    for (const double t : {0.1, 0.3, 0.5}) {
      const Matrix3 turned = independent_axes(whitened_moments(mesh, kTurn * rotation(1, 0, 0, t))).axes;
      EXPECT_LT(apart(turned, axes), 1e-10);
    }
  }
}

TEST(IndependentAxes, OfABallAreTheCoordinateAxes) {
  EXPECT_EQ(independent_axes(whitened_moments(make_sphere(2, 80), kTurn)).axes, kIdentity3);
}

}  // namespace
}  // namespace affskel::core
