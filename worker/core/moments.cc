// Notation.  A tetrahedron has the corners 0, p, q, r (the point that all share is moved to 0), the volume
// V = p.(q x r) / 6, s = p + q + r and G = p p^T + q q^T + r r^T.  The mean of a product of linear forms over
// a simplex is a sum over the permutations of the factors: 3! / (n + 3)! times the sum over all permutations
// of n of the product over its cycles of the sum over the corners of the cycle's factors' product.
#include "core/moments.h"

#include "core/double_sum.h"

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

// The mesh's tetrahedra with `centre` at 0, mapped.
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

// The sum over all 24 permutations of the four factors w, w, w, w^T of |w|^2 w w^T, times `factor`.
void add_fourth(Symmetric& sum, double factor, const Corners& c) {
  const std::array<Vec3, 3> corners = {c.p, c.q, c.r};
  const Vec3 s = c.p + c.q + c.r;
  const double ss = dot(s, s);
  double trace = 0;
  Vec3 gs, cubes;  // G s and the sum of |v|^2 v
  for (const Vec3& v : corners) {
    const double vv = dot(v, v);
    trace += vv;
    gs = gs + dot(v, s) * v;
    cubes = cubes + vv * v;
  }
  add_scaled(sum, factor * (ss + trace), s, s);
  add_scaled(sum, 2 * factor, gs, s);
  add_scaled(sum, 2 * factor, s, gs);
  add_scaled(sum, 2 * factor, cubes, s);
  add_scaled(sum, 2 * factor, s, cubes);
  for (const Vec3& v : corners) {
    // (|s|^2 + tr G + 4 v.s + 6 |v|^2) v v^T, and 2 G G as 2 v (v.w) w^T.
    add_scaled(sum, factor * (ss + trace + 4 * dot(v, s) + 6 * dot(v, v)), v, v);
    for (const Vec3& w : corners) add_scaled(sum, 2 * factor * dot(v, w), v, w);
  }
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
  result.centroid = centre + Vec3{x.value() / (4 * six), y.value() / (4 * six), z.value() / (4 * six)};
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

Matrix3 fourth_moment(const Mesh& mesh, double volume, const Vec3& centre, const Matrix3& map) {
  Symmetric sum;
  for_each_tetrahedron(mesh, centre, [&](const Corners& c) {
    add_fourth(sum, c.six_volumes(), {map * c.p, map * c.q, map * c.r});
  });
  return matrix(sum, 6 * 840 * volume);
}

}  // namespace affskel::core
