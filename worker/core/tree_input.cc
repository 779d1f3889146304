#include "core/tree_input.h"

#include <array>
#include <cmath>

namespace affskel::core {
namespace {

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

}  // namespace

TreeInput::Data::Data(const Solid& s)
    : solid(s),
      pseudonormal(s.mesh.points.size()),
      fan_begin(s.mesh.points.size() + 2, 0),
      fan_triangles(3 * s.mesh.triangles.size()),
      vertex_solid(s.mesh.points.size(), 0),
      rays(s.mesh) {
  const Mesh& mesh = s.mesh;
  area_vector.reserve(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    const std::array<Vec3, 3> p = {mesh.points[c[0]], mesh.points[c[1]], mesh.points[c[2]]};
    const Vec3 twice = cross(p[1] - p[0], p[2] - p[0]);
    area_vector.push_back(0.5 * twice);
    const double length = norm(twice);
    surface_area += 0.5 * length;
    for (std::size_t i = 0; i < 3; ++i) {
      ++fan_begin[c[i] + 2];
      vertex_solid[c[i]] = s.shells[s.triangle_shell[t]].solid;
      if (length == 0) continue;
      const double angle = angle_between(p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
      pseudonormal[c[i]] = pseudonormal[c[i]] + (angle / length) * twice;
    }
  }
  for (std::size_t v = 2; v < fan_begin.size(); ++v) fan_begin[v] += fan_begin[v - 1];
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t v : mesh.triangles[t]) fan_triangles[fan_begin[v + 1]++] = t;
  }
  for (double v : s.solid_volume) {
    solid_volume.push_back(std::ldexp(v, -3 * s.exponent));
    volume += solid_volume.back();
  }
}

TreeInput::TreeInput(const Solid& solid) : data_(std::make_unique<Data>(solid)) {}
TreeInput::~TreeInput() = default;

double TreeInput::volume_tolerance() const {
  return 1e-9 * data_->volume + kLevelHeight * data_->surface_area;
}

TreeInput::TreeInput(TreeInput&&) noexcept = default;

}  // namespace affskel::core
