#pragma once

#include <array>

#include "core/base/matrix3.h"

namespace affskel::core {

/// Eigenvalues, descending, and the unit eigenvectors that belong to them, orthogonal to rounding; of either
/// sign.
struct SymmetricEigen {
  std::array<double, 3> values{};
  Matrix3 vectors{};
};

/// By cyclic Jacobi rotations (Jacobi 1846; Golub & Van Loan, section 8.5), to rounding.  Uses +, -, *, / and
/// sqrt only, so that all machines agree on every bit; a diagonal matrix keeps its axes exactly.
/// @param m symmetric: the entries below the diagonal are not read.
SymmetricEigen symmetric_eigen(const Matrix3& m);

}  // namespace affskel::core
