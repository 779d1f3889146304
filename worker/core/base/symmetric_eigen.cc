#include "core/base/symmetric_eigen.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace affskel::core {
namespace {

// Convergence is quadratic: ten sweeps are already more than any matrix needs.
constexpr int kMaxSweeps = 30;

class Jacobi {
 public:
  explicit Jacobi(const Matrix3& m)
      : a_{{{m[0].x, m[1].x, m[2].x}, {m[1].x, m[1].y, m[2].y}, {m[2].x, m[2].y, m[2].z}}} {}

  SymmetricEigen run() {
    for (int sweep = 0; sweep < kMaxSweeps && !is_diagonal(); ++sweep) {
      rotate(0, 1);
      rotate(0, 2);
      rotate(1, 2);
    }
    return sorted();
  }

 private:
  bool is_diagonal() const { return a_[0][1] == 0 && a_[0][2] == 0 && a_[1][2] == 0; }

  // Makes a[p][q] zero.
  void rotate(std::size_t p, std::size_t q) {
    const double off = a_[p][q];
    if (off == 0) return;
    const double big = std::abs(a_[p][p]) + std::abs(a_[q][q]);
    if (big + std::abs(off) == big) {  // below rounding
      a_[p][q] = a_[q][p] = 0;
      return;
    }
    const double theta = (a_[q][q] - a_[p][p]) / (2 * off);
    const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
    const double c = 1 / std::sqrt(t * t + 1), s = t * c;
    a_[p][p] -= t * off;
    a_[q][q] += t * off;
    a_[p][q] = a_[q][p] = 0;
    const std::size_t r = 3 - p - q;
    const double rp = a_[r][p], rq = a_[r][q];
    a_[r][p] = a_[p][r] = c * rp - s * rq;
    a_[r][q] = a_[q][r] = s * rp + c * rq;
    const Vec3 vp = vectors_[p], vq = vectors_[q];
    vectors_[p] = c * vp - s * vq;
    vectors_[q] = s * vp + c * vq;
  }

  SymmetricEigen sorted() const {
    std::array<std::size_t, 3> order = {0, 1, 2};
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t i, std::size_t j) { return a_[i][i] > a_[j][j]; });
    SymmetricEigen result;
    for (std::size_t k = 0; k < 3; ++k) {
      result.values[k] = a_[order[k]][order[k]];
      result.vectors[k] = (1 / norm(vectors_[order[k]])) * vectors_[order[k]];
    }
    return result;
  }

  std::array<std::array<double, 3>, 3> a_;
  Matrix3 vectors_ = kIdentity3;
};

}  // namespace

SymmetricEigen symmetric_eigen(const Matrix3& m) {
  return Jacobi(m).run();
}

}  // namespace affskel::core
