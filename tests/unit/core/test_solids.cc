#include "core/test_solids.h"

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

constexpr double kHalfTurn = 3.14159265358979323846;

// The surface swept by turning a closed polygon (r, z) round the z axis; r = 0 gives a point of the axis.
Mesh turned(const std::vector<std::pair<double, double>>& profile, std::uint32_t segments) {
  Mesh mesh;
  std::vector<std::vector<std::uint32_t>> ring(profile.size());
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const auto [r, z] = profile[i];
    for (std::uint32_t s = 0; s < segments; ++s) {
      if (r == 0 && s > 0) {
        ring[i].push_back(ring[i][0]);
        continue;
      }
      const double angle = 2 * kHalfTurn * s / segments;
      ring[i].push_back(static_cast<std::uint32_t>(mesh.points.size()));
      mesh.points.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
  }
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    for (std::uint32_t s = 0; s < segments; ++s) {
      const std::uint32_t t = (s + 1) % segments;
      const std::uint32_t a = ring[i][s], b = ring[i][t], c = ring[i + 1][t], d = ring[i + 1][s];
      if (a != b) mesh.triangles.push_back({a, b, c});
      if (c != d) mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

}  // namespace

Mesh moved(Mesh mesh, const Vec3& by, double scale) {
  for (Vec3& p : mesh.points) p = scale * p + by;
  return mesh;
}

Mesh reversed(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

Mesh joined(Mesh a, const Mesh& b) {
  const auto offset = static_cast<std::uint32_t>(a.points.size());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return a;
}

Mesh overlapping_boxes(double a, double b, double c) {
  constexpr double kInset = 0.01, kHalf = 1.7;
  return joined(
      make_box(a, b, 0.5 * c + kHalf),
      moved(make_box(a - 2 * kInset, b - 2 * kInset, 0.5 * c + kHalf), {kInset, kInset, 0.5 * c - kHalf}));
}

Mesh shaken(Mesh mesh, double noise, std::uint64_t seed) {
  // Columns of a rotation: Gram-Schmidt from two vectors that depend on the seed.
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto draw = [&] { return Vec3{coordinate(random), coordinate(random), coordinate(random)}; };
  Vec3 u = draw(), v = draw();
  u = (1 / norm(u)) * u;
  v = v - dot(u, v) * u;
  v = (1 / norm(v)) * v;
  const Vec3 w = cross(u, v);
  for (Vec3& p : mesh.points) p = (p.x * u + p.y * v) + (p.z * w + noise * draw());
  return mesh;
}

Mesh make_coil() {
  constexpr double kTurn = 2 * std::numbers::pi, kRise = 0.3;
  Mesh mesh = make_box(1.5 * kTurn, 1, 1, 24);
  for (Vec3& p : mesh.points) {
    const double radius = 3 + p.y;
    p = {radius * std::cos(p.x), radius * std::sin(p.x), p.z + kRise * p.x / kTurn};
  }
  return reversed(std::move(mesh));
}

Mesh hollow_ball() {
  return joined(make_sphere(3, 320), reversed(moved(make_sphere(1, 80), {0.5, 0, 0})));
}

Mesh cup(std::uint32_t segments) {
  return turned({{0, 0}, {2, 0}, {2, 3}, {1.5, 3}, {1.5, 1}, {0, 1}}, segments);
}

Mesh comb(std::uint32_t teeth) {
  // Unit cells of the profile in the xz plane, extruded along y; faces between two cells cancel.
  std::map<std::pair<int, int>, bool> cell;
  for (int x = 0; x < static_cast<int>(2 * teeth) - 1; ++x) {
    cell[{x, 3}] = true;
    for (int z = 0; x % 2 == 0 && z < 3; ++z) cell[{x, z}] = true;
  }
  Mesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> name;
  const auto vertex = [&](int x, int y, int z) {
    const auto [at, fresh] = name.try_emplace({x, y, z}, static_cast<std::uint32_t>(mesh.points.size()));
    if (fresh) mesh.points.push_back({double(x), double(y), double(z)});
    return at->second;
  };
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (const auto& [at, filled] : cell) {
    const auto [x, z] = at;
    static_cast<void>(filled);
    quad(vertex(x, 0, z), vertex(x + 1, 0, z), vertex(x + 1, 0, z + 1), vertex(x, 0, z + 1));
    quad(vertex(x, 1, z + 1), vertex(x + 1, 1, z + 1), vertex(x + 1, 1, z), vertex(x, 1, z));
    if (!cell.count({x - 1, z}))
      quad(vertex(x, 0, z), vertex(x, 0, z + 1), vertex(x, 1, z + 1), vertex(x, 1, z));
    if (!cell.count({x + 1, z})) {
      quad(vertex(x + 1, 0, z), vertex(x + 1, 1, z), vertex(x + 1, 1, z + 1), vertex(x + 1, 0, z + 1));
    }
    if (!cell.count({x, z - 1}))
      quad(vertex(x, 0, z), vertex(x, 1, z), vertex(x + 1, 1, z), vertex(x + 1, 0, z));
    if (!cell.count({x, z + 1})) {
      quad(vertex(x, 0, z + 1), vertex(x + 1, 0, z + 1), vertex(x + 1, 1, z + 1), vertex(x, 1, z + 1));
    }
  }
  return mesh;
}

}  // namespace affskel::core
