// Notation.  The axes u_i (i = 0, 1, 2) are the columns of a rotation, T = E[w w w w], M_i = T u_i u_i,
// t_i = M_i u_i, k_i = t_i.u_i, J = sum (k_i - 3)^2.  A small turn r (a vector in the coordinates of w) takes
// u to u + r x u + r x (r x u) / 2, hence
//   k_i -> k_i + 4 r.(u_i x t_i) + 6 (r x u_i).M_i (r x u_i) + 2 ((t_i.r) (u_i.r) - k_i r.r).
//
// The maximum is the largest of those that Newton's iteration reaches from 343 rotations, spread over all
// that differ by more than order and signs.
//
// Ties.  Values that differ by less than 1e-6 of sum k^2 count as equal.  Of equal maxima the rotation
// nearest to the coordinate axes is taken.  Where the contrast stays the same when the axes turn about one
// line, they are turned so that the axis nearest to the plane across that line, and the coordinate axis
// nearest to that plane, project onto it in the same direction.  About more lines than one, the result is the
// coordinate axes.
#include "core/solid/independent_axes.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/axis_choice.h"
#include "core/base/symmetric_eigen.h"

namespace affskel::core {
namespace {

constexpr double kGaussian = 3;    // the kurtosis of a Gaussian
constexpr int kStartsPerEdge = 7;  // starts: 7^3
constexpr int kSearchSteps = 20;   // to tell the maxima apart
constexpr int kPolishSteps = 30;   // to reach the chosen one to rounding
constexpr double kMaxStep = 0.3;   // radian

// Unnormalised: the turn by 2 atan(|v| / s) about v.
struct Quaternion {
  double s = 1;
  Vec3 v;
};

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a.s * b.s - dot(a.v, b.v), a.s * b.v + (b.s * a.v + cross(a.v, b.v))};
}

Quaternion normalised(const Quaternion& q) {
  const double factor = 1 / std::sqrt(q.s * q.s + dot(q.v, q.v));
  return {factor * q.s, factor * q.v};
}

Matrix3 rotation(const Quaternion& q) {
  const double s = q.s, x = q.v.x, y = q.v.y, z = q.v.z;
  return {Vec3{1 - 2 * (y * y + z * z), 2 * (x * y + s * z), 2 * (x * z - s * y)},
          Vec3{2 * (x * y - s * z), 1 - 2 * (x * x + z * z), 2 * (y * z + s * x)},
          Vec3{2 * (x * z + s * y), 2 * (y * z - s * x), 1 - 2 * (x * x + y * y)}};
}

// J and its derivatives by a turn.
struct Contrast {
  double value = 0;
  Vec3 gradient;
  Matrix3 hessian{};
  std::array<double, 3> kurtosis{};
  double scale() const {
    double sum = 0;
    for (const double k : kurtosis) sum += k * k;
    return sum;
  }
};

class Ascent {
 public:
  explicit Ascent(const FourthMoments& moments) : moments_(moments) {}

  Contrast contrast(const Matrix3& axes) const {
    Contrast result;
    for (std::size_t i = 0; i < 3; ++i) add_axis(axes[i], i, result);
    return result;
  }

  // Newton steps uphill: along eigenvectors of the Hessian, so that saddles repel.
  Quaternion climbed(Quaternion q, int steps) const {
    for (int n = 0; n < steps; ++n) q = normalised(product({1, 0.5 * step(rotation(q))}, q));
    return q;
  }

 private:
  Matrix3 contracted(const Vec3& u) const {
    Matrix3 m{};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        m = m + (u[a] * u[b]) * moments_[a][b];
      }
    }
    return m;
  }

  void add_axis(const Vec3& u, std::size_t i, Contrast& sum) const {
    const Matrix3 m = contracted(u);
    const Vec3 t = m * u;
    const double k = dot(t, u), excess = k - kGaussian;
    const Vec3 slope = 4 * cross(u, t);
    Matrix3 bend = 2 * (outer(t, u) + outer(u, t)) + -4 * k * kIdentity3;
    for (std::size_t b = 0; b < 3; ++b) {
      const Vec3 moved = m * cross(kIdentity3[b], u);
      bend[b] = bend[b] + 12 * cross(u, moved);  // (e_a x u).v = e_a.(u x v)
    }
    sum.kurtosis[i] = k;
    sum.value += excess * excess;
    sum.gradient = sum.gradient + 2 * excess * slope;
    sum.hessian = sum.hessian + (2 * outer(slope, slope) + 2 * excess * bend);
  }

  Vec3 step(const Matrix3& axes) const {
    const Contrast c = contrast(axes);
    const SymmetricEigen eigen = symmetric_eigen(c.hessian);
    const double least = kAxisTie * c.scale();
    Vec3 turn;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& e = eigen.vectors[i];
      turn = turn + (dot(c.gradient, e) / std::max(std::abs(eigen.values[i]), least)) * e;
    }
    const double length = norm(turn);
    return length > kMaxStep ? (kMaxStep / length) * turn : turn;
  }

  const FourthMoments& moments_;
};

// All rotations but for order and signs of the axes: |v| / s of what is left lies in a cube of half the edge
// tan(22.5 degrees) (less its corners), the middle first.
std::vector<Quaternion> starts() {
  const double edge = 2 * (std::sqrt(2.0) - 1) / kStartsPerEdge;
  constexpr int kHalf = kStartsPerEdge / 2;
  std::vector<Quaternion> result = {{}};
  for (int x = -kHalf; x <= kHalf; ++x) {
    for (int y = -kHalf; y <= kHalf; ++y) {
      for (int z = -kHalf; z <= kHalf; ++z) {
        if (x != 0 || y != 0 || z != 0) result.push_back(normalised({1, {edge * x, edge * y, edge * z}}));
      }
    }
  }
  return result;
}

// How near the axes are to the coordinate axes, whatever their order and signs: 3 at most.
double nearness(const Matrix3& axes) {
  double sum = 0;
  for (const Vec3& u : axes) sum += std::max({u.x * u.x, u.y * u.y, u.z * u.z});
  return sum;
}

Quaternion best_start(const Ascent& ascent) {
  struct Candidate {
    Quaternion q;
    Contrast contrast;
  };
  std::vector<Candidate> candidates;
  std::size_t best = 0;
  for (const Quaternion& start : starts()) {
    const Quaternion q = ascent.climbed(start, kSearchSteps);
    candidates.push_back({q, ascent.contrast(rotation(q))});
    if (candidates.back().contrast.value > candidates[best].contrast.value) best = candidates.size() - 1;
  }
  const Contrast& top = candidates[best].contrast;
  const double enough = top.value - kAxisTie * top.scale();
  double nearest = 0;
  for (std::size_t n = 0; n < candidates.size(); ++n) {
    if (candidates[n].contrast.value < enough) continue;
    const double near = nearness(rotation(candidates[n].q));
    if (near <= nearest + kAxisTie) continue;
    nearest = near;
    best = n;
  }
  return candidates[best].q;
}

// The axes turned about `line` (a unit vector), see the head of this file.
Matrix3 turned_about(const Vec3& line, const Matrix3& axes) {
  std::size_t flattest = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (std::abs(dot(axes[i], line)) < std::abs(dot(axes[flattest], line)) - kAxisTie) flattest = i;
  }
  const Vec3 from = unit(axes[flattest] - dot(axes[flattest], line) * line), to = plane_axes(line)[0];
  const double cosine = dot(from, to), sine = dot(cross(from, to), line);
  Matrix3 result{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 along = dot(axes[i], line) * line;
    result[i] = along + (cosine * (axes[i] - along) + sine * cross(line, axes[i]));
  }
  return result;
}

}  // namespace

IndependentAxes independent_axes(const FourthMoments& moments) {
  const Ascent ascent(moments);
  Matrix3 axes = orthonormal(rotation(ascent.climbed(best_start(ascent), kPolishSteps)));
  const Contrast top = ascent.contrast(axes);
  const SymmetricEigen eigen = symmetric_eigen(top.hessian);
  int free = 0;
  Vec3 line;
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(eigen.values[i]) > kAxisTie * top.scale()) continue;
    ++free;
    line = eigen.vectors[i];
  }
  if (free == 1) axes = orthonormal(turned_about(line, axes));
  if (free > 1) axes = kIdentity3;
  return {axes, ascent.contrast(axes).kurtosis};
}

}  // namespace affskel::core
