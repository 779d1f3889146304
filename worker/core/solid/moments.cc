// Notation.  A tetrahedron has the corners 0, p, q, r (the point that all share is moved to 0), the volume
// V = p.(q x r) / 6 and s = p + q + r.  The mean of a product of n linear forms over a simplex is 3! / (n +
// 3)! times a sum over the permutations of the factors: of the product, over the permutation's cycles, of the
// sum over the corners of the product of the cycle's factors.
#include "core/solid/moments.h"

#include <algorithm>

#include "core/base/double_sum.h"

namespace affskel::core {
namespace {

using Symmetric = std::array<DoubleSum, 6>;  // xx, xy, xz, yy, yz, zz

struct Corners {
  Vec3 p, q, r;
  double six_volumes() const { return dot(p, cross(q, r)); }
};

void add_scaled(Symmetric& sum, double factor, const Vec3& a, const Vec3& b) {
  const Vec3 fa = factor * a;
  sum[0].add(fa.x * b.x);
  sum[1].add(fa.x * b.y);
  sum[2].add(fa.x * b.z);
  sum[3].add(fa.y * b.y);
  sum[4].add(fa.y * b.z);
  sum[5].add(fa.z * b.z);
}

Matrix3 matrix(const Symmetric& sum, double divisor) {
  std::array<double, 6> m{};
  for (std::size_t i = 0; i < 6; ++i) m[i] = sum[i].value() / divisor;
  return {Vec3{m[0], m[1], m[2]}, Vec3{m[1], m[3], m[4]}, Vec3{m[2], m[4], m[5]}};
}

// The mesh's tetrahedra with `centre` at 0.
template <class Visit>
void for_each_tetrahedron(const Mesh& mesh, const Vec3& centre, Visit visit) {
  for (const Triangle& t : mesh.triangles) {
    visit(Corners{mesh.points[t[0]] - centre, mesh.points[t[1]] - centre, mesh.points[t[2]] - centre});
  }
}

// Somewhere in the middle, so that little cancels.
Vec3 middle(const Mesh& mesh) {
  Vec3 sum;
  for (const Vec3& p : mesh.points) sum = sum + p;
  return mesh.points.empty() ? sum : (1 / static_cast<double>(mesh.points.size())) * sum;
}

// The 15 different products of four coordinates.
constexpr auto kProducts = [] {
  std::array<std::array<std::size_t, 4>, 15> products{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = i; j < 3; ++j)
      for (std::size_t k = j; k < 3; ++k)
        for (std::size_t l = k; l < 3; ++l) products[count++] = {i, j, k, l};
  return products;
}();

// The sum over all 24 permutations of the four factors w_i, w_j, w_k, w_l: by the lengths of their cycles
// 1+1+1+1, 2+1+1 (six ways), 2+2 (three), 3+1 (four, each in two senses) and 4 (six senses).
double permutation_sum(const Corners& t, const std::array<std::size_t, 4>& product) {
  const auto [i, j, k, l] = product;
  const Vec3 &p = t.p, &q = t.q, &r = t.r, s = p + q + r;
  const auto pair = [&](std::size_t a, std::size_t b) { return p[a] * p[b] + q[a] * q[b] + r[a] * r[b]; };
  const auto triple = [&](std::size_t a, std::size_t b, std::size_t c) {
    return p[a] * p[b] * p[c] + q[a] * q[b] * q[c] + r[a] * r[b] * r[c];
  };
  const double ij = pair(i, j), ik = pair(i, k), il = pair(i, l), jk = pair(j, k), jl = pair(j, l),
               kl = pair(k, l);
  const double ones = s[i] * s[j] * s[k] * s[l];
  const double twos = ij * s[k] * s[l] + ik * s[j] * s[l] + il * s[j] * s[k] + jk * s[i] * s[l] +
                      jl * s[i] * s[k] + kl * s[i] * s[j];
  const double threes =
      triple(i, j, k) * s[l] + triple(i, j, l) * s[k] + triple(i, k, l) * s[j] + triple(j, k, l) * s[i];
  const double four = p[i] * p[j] * p[k] * p[l] + q[i] * q[j] * q[k] * q[l] + r[i] * r[j] * r[k] * r[l];
  return ones + twos + (ij * kl + ik * jl + il * jk) + 2 * threes + 6 * four;
}

}  // namespace

Moments solid_moments(const Mesh& mesh) {
  const Vec3 centre = middle(mesh);
  DoubleSum volume, x, y, z;
  for_each_tetrahedron(mesh, centre, [&](const Corners& c) {
    const double v = c.six_volumes();
    const Vec3 s = v * (c.p + c.q + c.r);
    volume.add(v);
    x.add(s.x);
    y.add(s.y);
    z.add(s.z);
  });
  Moments result;
  const double six = volume.value();
  result.volume = six / 6;
  result.centroid = centre + Vec3{x.value(), y.value(), z.value()} / (4 * six);
  Symmetric second;
  for_each_tetrahedron(mesh, result.centroid, [&](const Corners& c) {
    const double v = c.six_volumes();
    for (const Vec3& corner : {c.p, c.q, c.r, c.p + c.q + c.r}) add_scaled(second, v, corner, corner);
  });
  result.covariance = matrix(second, 20 * six);
  return result;
}

double third_moment(const Mesh& mesh, double volume, const Vec3& centre, const Vec3& axis) {
  DoubleSum sum;
  for_each_tetrahedron(mesh, centre, [&](const Corners& t) {
    const double a = dot(axis, t.p), b = dot(axis, t.q), c = dot(axis, t.r);
    // The complete homogeneous polynomial of degree 3.
    const double h =
        a * (a * (a + b + c) + b * b + c * c) + b * (b * (b + c) + c * c) + c * c * c + a * b * c;
    sum.add(t.six_volumes() * h);
  });
  return sum.value() / (120 * volume);
}

FourthMoments fourth_moments(const Mesh& mesh, double volume, const Vec3& centre, const Matrix3& map) {
  std::array<DoubleSum, kProducts.size()> sum{};
  for_each_tetrahedron(mesh, centre, [&](const Corners& c) {
    const double six = c.six_volumes();
    const Corners mapped{map * c.p, map * c.q, map * c.r};
    for (std::size_t n = 0; n < sum.size(); ++n) sum[n].add(six * permutation_sum(mapped, kProducts[n]));
  });
  const auto value = [&](std::array<std::size_t, 4> product) {
    std::sort(product.begin(), product.end());
    const auto at = std::find(kProducts.begin(), kProducts.end(), product) - kProducts.begin();
    return sum[static_cast<std::size_t>(at)].value() / (6 * 840 * volume);
  };
  FourthMoments result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k)
        result[i][j][k] = {value({i, j, k, 0}), value({i, j, k, 1}), value({i, j, k, 2})};
  return result;
}

}  // namespace affskel::core
