#include "core/base/symmetric_eigen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace affskel::core {
namespace {

// A v = lambda v, orthonormal, descending.
void expect_eigen(const Matrix3& a, const SymmetricEigen& e, double size) {
  EXPECT_GE(e.values[0], e.values[1]);
  EXPECT_GE(e.values[1], e.values[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_LT(norm(a * e.vectors[k] - e.values[k] * e.vectors[k]), 1e-14 * size);
    for (std::size_t l = 0; l < 3; ++l) EXPECT_NEAR(dot(e.vectors[k], e.vectors[l]), k == l ? 1 : 0, 2e-15);
  }
}

TEST(SymmetricEigen, SolvesRandomMatrices) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> entry(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const double size = std::ldexp(1.0, i % 200 - 100), tiny = i % 3 == 0 ? 1e-9 : 1;
    const double a = size * entry(random), b = size * entry(random), c = size * entry(random),
                 d = tiny * size * entry(random), e = tiny * size * entry(random),
                 f = tiny * size * entry(random);
    const Matrix3 m = {Vec3{a, d, e}, Vec3{d, b, f}, Vec3{e, f, c}};
    expect_eigen(m, symmetric_eigen(m), size);
  }
}

TEST(SymmetricEigen, KeepsTheAxesOfADiagonalMatrix) {
  const SymmetricEigen e = symmetric_eigen({Vec3{1, 0, 0}, Vec3{0, 3, 0}, Vec3{0, 0, 2}});
  EXPECT_EQ(e.values, (std::array<double, 3>{3, 2, 1}));
  EXPECT_EQ(e.vectors, (Matrix3{Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{1, 0, 0}}));
  EXPECT_EQ(symmetric_eigen(kIdentity3).vectors, kIdentity3);
}

// Eigenvalues 3, 0, 0.
TEST(SymmetricEigen, SolvesARankOneMatrix) {
  const Matrix3 ones = {Vec3{1, 1, 1}, Vec3{1, 1, 1}, Vec3{1, 1, 1}};
  const SymmetricEigen e = symmetric_eigen(ones);
  expect_eigen(ones, e, 1);
  EXPECT_NEAR(e.values[0], 3, 1e-15);
  EXPECT_NEAR(e.values[1], 0, 1e-15);
}

}  // namespace
}  // namespace affskel::core
