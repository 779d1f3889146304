#include "hard_solids.h"

#include <cmath>

#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::reference {
namespace {

using core::Mesh;
using core::Vec3;

constexpr double kPi = 3.14159265358979323846;

// Rings of `sides` vertices, one after the other, joined to a tube with flat ends.
void close_tube(std::uint32_t rings, std::uint32_t sides, const Vec3& begin, const Vec3& end, Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.push_back(begin);
  mesh.points.push_back(end);
  const std::uint32_t last_ring = (rings - 1) * sides;
  for (std::uint32_t s = 0; s < sides; ++s) {
    const std::uint32_t t = (s + 1) % sides;
    for (std::uint32_t r = 0; r + 1 < rings; ++r) {
      const std::uint32_t a = r * sides + s, b = r * sides + t;
      mesh.triangles.push_back({a, b, b + sides});
      mesh.triangles.push_back({a, b + sides, a + sides});
    }
    mesh.triangles.push_back({first, t, s});
    mesh.triangles.push_back({first + 1, last_ring + s, last_ring + t});
  }
}

}  // namespace

Mesh make_helix(double radius, double tube, double pitch, std::uint32_t turns, std::uint32_t segments,
                std::uint32_t sides) {
  Mesh mesh;
  const std::uint32_t rings = turns * segments + 1;
  const auto axis = [&](std::uint32_t ring) {
    const double angle = 2 * kPi * ring / segments;
    return Vec3{radius * std::cos(angle), radius * std::sin(angle), pitch * ring / segments};
  };
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    const double angle = 2 * kPi * ring / segments;
    const Vec3 outward{std::cos(angle), std::sin(angle), 0};
    for (std::uint32_t s = 0; s < sides; ++s) {
      // Clockwise seen along the tube's way, which makes the sides face out with the winding above.
      const double turn = -2 * kPi * s / sides;
      mesh.points.push_back(axis(ring) + tube * (std::cos(turn) * outward + std::sin(turn) * Vec3{0, 0, 1}));
    }
  }
  close_tube(rings, sides, axis(0), axis(rings - 1), mesh);
  return mesh;
}

Mesh linked_tori(std::uint32_t triangles_each) {
  Mesh upright = core::make_torus(3, 0.8, triangles_each);
  for (Vec3& p : upright.points) p = {p.x + 3, -p.z, p.y};
  return joined(core::make_torus(3, 0.8, triangles_each), upright);
}

Mesh nested_shells() {
  Mesh mesh = joined(core::make_sphere(4, 80), core::reversed(core::make_sphere(3.2, 80)));
  mesh = joined(mesh, core::moved(core::make_sphere(2.4, 80), {0.1, 0, 0.2}));
  mesh = joined(mesh, core::moved(core::reversed(core::make_sphere(1.6, 80)), {0.1, 0, 0.2}));
  return joined(mesh, core::moved(core::make_sphere(0.9, 80), {0, 0.2, 0.1}));
}

}  // namespace affskel::reference
