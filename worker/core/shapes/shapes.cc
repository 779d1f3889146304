#include "core/shapes/shapes.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <unordered_map>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/mesh/geodesic_sphere.h"

namespace affskel::core {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::uint64_t kMaxTriangles = std::uint64_t{1} << 26;

void require_length(const char* shape, const char* name, double value) {
  if (!(std::isfinite(value) && value > 0)) {
    refuse(std::string(shape) + ": " + name + " must be a finite number > 0, not " + base::to_text(value));
  }
}

void require_at_least(const char* shape, const char* name, std::uint32_t value, std::uint32_t least) {
  if (value < least) {
    refuse(std::string(shape) + ": " + name + " must be at least " + std::to_string(least) + ", not " +
           std::to_string(value));
  }
}

void require_affordable(const char* shape, std::uint64_t triangles) {
  if (triangles > kMaxTriangles) {
    throw CoreError(CoreError::Code::kLimit, std::string(shape) + ": " + std::to_string(triangles) +
                                                 " triangles are more than the limit of " +
                                                 std::to_string(kMaxTriangles));
  }
}

/// Point k of `count` on the unit circle of the xy plane.
Vec3 on_circle(std::uint32_t k, std::uint32_t count) {
  const double angle = 2 * kPi * k / count;
  return {std::cos(angle), std::sin(angle), 0};
}

// --- torus -------------------------------------------------------------------------------------------

struct TorusGrid {
  std::uint32_t around_axis = 0;  // m
  std::uint32_t around_tube = 0;  // n
};

/// How far the polyhedron falls short of the smooth torus, in units of the minor radius; rho = R / r.
double torus_sagitta(double rho, double m, double n) {
  return (1 - std::cos(kPi / n)) + (rho + 1) * (1 - std::cos(kPi / m));
}

/// The best m x n = quads, or nothing when even that is far from what an unhindered choice would give.
std::optional<TorusGrid> torus_grid(double rho, std::uint32_t quads) {
  std::optional<TorusGrid> best;
  double best_sagitta = 0;
  const auto consider = [&](std::uint32_t m, std::uint32_t n) {
    const double sagitta = torus_sagitta(rho, m, n);
    if (!best || sagitta < best_sagitta) {
      best = TorusGrid{m, n};
      best_sagitta = sagitta;
    }
  };
  for (std::uint32_t n = 3; std::uint64_t{n} * n <= quads; ++n) {
    if (quads % n != 0) continue;
    consider(quads / n, n);
    consider(n, quads / n);
  }
  // For real m and small angles the least sagitta is pi^2 sqrt(rho + 1) / quads.
  constexpr double kWorstToIdeal = 4;
  if (best && best_sagitta > kWorstToIdeal * kPi * kPi * std::sqrt(rho + 1) / quads) best.reset();
  return best;
}

/// " (try 6050 or 6060)": the nearest counts for which a grid exists.
std::string torus_suggestion(double rho, std::uint32_t triangles) {
  constexpr std::uint32_t kTries = 2000;
  std::string below, above;
  for (std::uint32_t d = 2; d <= kTries && below.empty() && triangles >= 18 + d; d += 2) {
    if (torus_grid(rho, (triangles - d) / 2)) below = std::to_string(triangles - d);
  }
  for (std::uint32_t d = 2; d <= kTries && above.empty(); d += 2) {
    if (torus_grid(rho, (triangles + d) / 2)) above = std::to_string(triangles + d);
  }
  if (below.empty() && above.empty()) return "";
  const std::string both = below.empty() || above.empty() ? "" : " or ";
  return "; try " + below + both + above;
}

// --- geodesic sphere ---------------------------------------------------------------------------------

Mesh unit_sphere(const char* shape, std::uint32_t at_least_triangles) {
  require_affordable(shape, at_least_triangles);
  std::uint32_t frequency = 1;
  while (20 * frequency * frequency < at_least_triangles) ++frequency;
  return geodesic_sphere(frequency);
}

// --- box ---------------------------------------------------------------------------------------------

/// The lattice points on the surface of a cube of n^3 cells, each with one vertex.
class BoxVertices {
 public:
  BoxVertices(double a, double b, double c, std::uint32_t n, Mesh& out) : size_{a, b, c}, n_(n), out_(out) {}

  std::uint32_t at(const std::array<std::uint32_t, 3>& p) {
    const std::uint64_t side = std::uint64_t{n_} + 1;
    const auto [place, is_new] = vertex_.try_emplace((p[0] * side + p[1]) * side + p[2], 0);
    if (is_new) {
      place->second = static_cast<std::uint32_t>(out_.points.size());
      out_.points.push_back({coordinate(0, p[0]), coordinate(1, p[1]), coordinate(2, p[2])});
    }
    return place->second;
  }

 private:
  // Exact at both ends: i / n is 1 at i = n.
  double coordinate(int axis, std::uint32_t i) const { return size_[axis] * (double(i) / n_); }

  Vec3 size_;
  std::uint32_t n_;
  Mesh& out_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_;
};

/// The face normal to `axis` at its low (end = 0) or high (end = 1) side.
void add_box_face(BoxVertices& vertices, std::size_t axis, bool high, std::uint32_t n, Mesh& mesh) {
  std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (!high) std::swap(u, v);
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    std::array<std::uint32_t, 3> p{};
    p[axis] = high ? n : 0;
    p[u] = i;
    p[v] = j;
    return vertices.at(p);
  };
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t p = at(i, j), q = at(i + 1, j), r = at(i + 1, j + 1), s = at(i, j + 1);
      mesh.triangles.push_back({p, q, r});
      mesh.triangles.push_back({p, r, s});
    }
  }
}

/// A fan from `centre` over the ring first .. first + count - 1; `up`: seen counter-clockwise from +z.
void add_fan(std::uint32_t centre, std::uint32_t first, std::uint32_t count, bool up, Mesh& mesh) {
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t p = first + k, q = first + (k + 1) % count;
    mesh.triangles.push_back(up ? Triangle{centre, p, q} : Triangle{centre, q, p});
  }
}

}  // namespace

Mesh make_torus(double major_radius, double minor_radius, std::uint32_t triangles) {
  require_length("torus", "the minor radius", minor_radius);
  require_length("torus", "the major radius", major_radius);
  if (major_radius <= minor_radius) {
    refuse("torus: the major radius must exceed the minor radius, but " + base::to_text(major_radius) +
           " <= " + base::to_text(minor_radius));
  }
  require_at_least("torus", "the number of triangles", triangles, 18);
  require_affordable("torus", triangles);
  if (triangles % 2 != 0) {
    refuse("torus: the number of triangles must be even, not " + std::to_string(triangles));
  }
  const double rho = major_radius / minor_radius;
  const std::optional<TorusGrid> grid = torus_grid(rho, triangles / 2);
  if (!grid) {
    refuse("torus: " + std::to_string(triangles) +
           " triangles do not fill a grid of segments around axis and tube without being slivers" +
           torus_suggestion(rho, triangles));
  }
  const std::uint32_t m = grid->around_axis, n = grid->around_tube;
  Mesh mesh;
  for (std::uint32_t i = 0; i < m; ++i) {
    const Vec3 out = on_circle(i, m);
    for (std::uint32_t j = 0; j < n; ++j) {
      const Vec3 tube = on_circle(j, n);
      const Vec3 ring = (major_radius + minor_radius * tube.x) * out;
      mesh.points.push_back({ring.x, ring.y, minor_radius * tube.y});
    }
  }
  for (std::uint32_t i = 0; i < m; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t i1 = (i + 1) % m, j1 = (j + 1) % n;
      const std::uint32_t p = i * n + j, q = i1 * n + j, r = i1 * n + j1, s = i * n + j1;
      mesh.triangles.push_back({p, q, r});
      mesh.triangles.push_back({p, r, s});
    }
  }
  return mesh;
}

Mesh make_sphere(double radius, std::uint32_t at_least_triangles) {
  require_length("sphere", "the radius", radius);
  Mesh mesh = unit_sphere("sphere", at_least_triangles);
  for (Vec3& p : mesh.points) p = radius * p;
  return mesh;
}

Mesh make_ellipsoid(double a, double b, double c, std::uint32_t at_least_triangles) {
  require_length("ellipsoid", "the semi-axis along x", a);
  require_length("ellipsoid", "the semi-axis along y", b);
  require_length("ellipsoid", "the semi-axis along z", c);
  Mesh mesh = unit_sphere("ellipsoid", at_least_triangles);
  for (Vec3& p : mesh.points) p = {a * p.x, b * p.y, c * p.z};
  return mesh;
}

Mesh make_box(double a, double b, double c, std::uint32_t divisions) {
  require_length("box", "the side along x", a);
  require_length("box", "the side along y", b);
  require_length("box", "the side along z", c);
  require_at_least("box", "the number of divisions", divisions, 1);
  require_affordable("box",
                     divisions > 100000 ? kMaxTriangles + 1 : std::uint64_t{12} * divisions * divisions);
  Mesh mesh;
  BoxVertices vertices(a, b, c, divisions, mesh);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    add_box_face(vertices, axis, false, divisions, mesh);
    add_box_face(vertices, axis, true, divisions, mesh);
  }
  return mesh;
}

Mesh make_cylinder(double radius, double height, std::uint32_t segments) {
  require_length("cylinder", "the radius", radius);
  require_length("cylinder", "the height", height);
  require_at_least("cylinder", "the number of segments", segments, 3);
  require_affordable("cylinder", std::uint64_t{4} * segments);
  Mesh mesh;
  for (const double z : {0.0, height}) {
    for (std::uint32_t k = 0; k < segments; ++k) {
      const Vec3 p = radius * on_circle(k, segments);
      mesh.points.push_back({p.x, p.y, z});
    }
  }
  for (std::uint32_t k = 0; k < segments; ++k) {
    const std::uint32_t next = (k + 1) % segments;
    mesh.triangles.push_back({k, next, segments + next});
    mesh.triangles.push_back({k, segments + next, segments + k});
  }
  mesh.points.push_back({0, 0, 0});
  mesh.points.push_back({0, 0, height});
  add_fan(2 * segments, 0, segments, false, mesh);
  add_fan(2 * segments + 1, segments, segments, true, mesh);
  return mesh;
}

Mesh make_cone(double radius, double height, std::uint32_t segments) {
  require_length("cone", "the radius", radius);
  require_length("cone", "the height", height);
  require_at_least("cone", "the number of segments", segments, 3);
  require_affordable("cone", std::uint64_t{2} * segments);
  Mesh mesh;
  for (std::uint32_t k = 0; k < segments; ++k) mesh.points.push_back(radius * on_circle(k, segments));
  mesh.points.push_back({0, 0, 0});
  mesh.points.push_back({0, 0, height});
  add_fan(segments, 0, segments, false, mesh);
  add_fan(segments + 1, 0, segments, true, mesh);
  return mesh;
}

Mesh make_tetrahedron(double edge) {
  require_length("tetrahedron", "the edge", edge);
  const double inradius = edge / std::sqrt(24.0);
  const double base = edge / std::sqrt(3.0);  // circumradius of a face
  Mesh mesh;
  mesh.points = {{base, 0, -inradius},
                 {-base / 2, edge / 2, -inradius},
                 {-base / 2, -edge / 2, -inradius},
                 {0, 0, 3 * inradius}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

}  // namespace affskel::core
