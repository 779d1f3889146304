#include "open_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace affskel::reference {
namespace {

using core::Mesh;
using core::Triangle;
using core::Vec3;

constexpr double kGraze = 1e-9;
constexpr int kTries = 64;  // when all graze, the point lies on a side itself

class Cut {
 public:
  Cut(const Mesh& mesh, const Plane& plane, double tolerance) {
    surface_.points = mesh.points;
    for (const Vec3& p : mesh.points) {
      const double above = dot(plane.d, p) - plane.height;
      above_.push_back(std::abs(above) <= tolerance ? 0 : above);
    }
    for (const Triangle& t : mesh.triangles) triangle(t);
  }

  OpenSurface take() { return std::move(surface_); }

 private:
  void triangle(const Triangle& t) {
    int up = 0, down = 0;
    for (const std::uint32_t v : t) {
      up += above_[v] > 0;
      down += above_[v] < 0;
    }
    if (up == 0) {
      surface_.triangles.push_back(t);  // below, touching the plane from below, or in it
    } else if (down > 0) {
      reconstruct(t);
    }
  }

  // The corners below or on the plane and the new ones, in order: three or four.
  void reconstruct(const Triangle& t) {
    std::array<std::uint32_t, 4> ring{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = t[i], w = t[(i + 1) % 3];
      if (above_[v] <= 0) ring[count++] = v;
      if (above_[v] * above_[w] < 0) ring[count++] = new_vertex(v, w);
    }
    surface_.triangles.push_back({ring[0], ring[1], ring[2]});
    if (count == 4) surface_.triangles.push_back({ring[0], ring[2], ring[3]});
  }

  std::uint32_t new_vertex(std::uint32_t v, std::uint32_t w) {
    const std::pair<std::uint32_t, std::uint32_t> edge = std::minmax(v, w);
    const auto [at, fresh] = by_edge_.try_emplace(edge, static_cast<std::uint32_t>(surface_.points.size()));
    if (fresh) {
      const double share = above_[edge.first] / (above_[edge.first] - above_[edge.second]);
      const Vec3 &p = surface_.points[edge.first], &q = surface_.points[edge.second];
      surface_.points.push_back(p + share * (q - p));
    }
    return at->second;
  }

  OpenSurface surface_;
  std::vector<double> above_;  // per vertex of the mesh, 0 on the plane
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> by_edge_;
};

bool same_side(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  return (a == c && b == d) || (a == d && b == c);
}

bool share_a_side(const Triangle& s, const Triangle& t) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (same_side(s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3])) return true;
    }
  }
  return false;
}

Vec3 random_ray(std::mt19937_64& random) {
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (;;) {
    const Vec3 ray = {coordinate(random), coordinate(random), coordinate(random)};
    const double length = norm(ray);
    if (length > 0.1 && length <= 1) return (1 / length) * ray;
  }
}

}  // namespace

OpenSurface cut_and_reconstruct(const Mesh& mesh, const Plane& plane, double tolerance) {
  return Cut(mesh, plane, tolerance).take();
}

std::vector<std::vector<Triangle>> components(const std::vector<Triangle>& triangles) {
  std::vector<std::vector<Triangle>> found;
  std::vector<bool> visited(triangles.size(), false);
  std::vector<std::size_t> to_do;
  for (std::size_t seed = 0; seed < triangles.size(); ++seed) {
    if (visited[seed]) continue;
    visited[seed] = true;
    to_do.push_back(seed);
    found.emplace_back();
    while (!to_do.empty()) {
      const Triangle& reached = triangles[to_do.back()];
      to_do.pop_back();
      found.back().push_back(reached);
      for (std::size_t other = 0; other < triangles.size(); ++other) {
        if (visited[other] || !share_a_side(reached, triangles[other])) continue;
        visited[other] = true;
        to_do.push_back(other);
      }
    }
  }
  return found;
}

double boundary_integral(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                         const Vec3& p) {
  double sum = 0;
  for (const Triangle& t : triangles) {
    const Vec3 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
    const Vec3 centre = (1.0 / 3) * (a + b + c), area = 0.5 * cross(b - a, c - a);
    sum += dot(centre - p, area);
  }
  return sum / 3;
}

std::optional<RayHit> meet(const Vec3& origin, const Vec3& ray, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, from = origin - a;
  const Vec3 across = cross(ray, ac);
  const double determinant = dot(ab, across);
  if (determinant == 0) return {};
  const double u = dot(from, across) / determinant;
  if (u < -kGraze || u > 1 + kGraze) return {};
  const Vec3 along = cross(from, ab);
  const double v = dot(ray, along) / determinant;
  if (v < -kGraze || u + v > 1 + kGraze) return {};
  const double distance = dot(ac, along) / determinant;
  if (distance < 0) return {};
  return RayHit{u < kGraze || v < kGraze || u + v > 1 - kGraze, distance};
}

bool contains(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles, const Vec3& x,
              const Plane* plane, std::mt19937_64& random) {
  for (int tries = 0; tries < kTries; ++tries) {
    Vec3 ray = random_ray(random);
    if (plane != nullptr && dot(plane->d, ray) > 0) ray = -ray;
    bool inside = false, grazed = false;
    for (const Triangle& t : triangles) {
      const std::optional<RayHit> hit = meet(x, ray, points[t[0]], points[t[1]], points[t[2]]);
      if (!hit) continue;
      inside = !inside;
      grazed = grazed || hit->grazes;
    }
    if (!grazed) return inside;
  }
  return false;
}

}  // namespace affskel::reference
