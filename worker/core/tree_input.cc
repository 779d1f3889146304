#include "core/tree_input.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "core/solid_membership.h"

namespace affskel::core {
namespace {

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

Vec3 pseudonormal_of(const Mesh& mesh, std::uint32_t vertex, std::span<const std::uint32_t> fan) {
  Vec3 sum;
  for (std::uint32_t t : fan) {
    const Triangle& c = mesh.triangles[t];
    const std::size_t i = c[0] == vertex ? 0 : c[1] == vertex ? 1 : 2;
    const Vec3 &p = mesh.points[vertex], &q = mesh.points[c[(i + 1) % 3]], &r = mesh.points[c[(i + 2) % 3]];
    const Vec3 twice = cross(q - p, r - p);
    const double length = norm(twice);
    if (length != 0) sum = sum + (angle_between(q - p, r - p) / length) * twice;
  }
  return sum;
}

}  // namespace

TreeInput::Data::Data(const Solid& s, unsigned threads)
    : solid(s),
      pseudonormal(s.mesh.points.size()),
      fan_begin(s.mesh.points.size() + 2, 0),
      fan_triangles(3 * s.mesh.triangles.size()),
      vertex_solid(s.mesh.points.size(), 0),
      rays(s.mesh, threads) {
  const Mesh& mesh = s.mesh;
  area_vector.reserve(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    const std::array<Vec3, 3> p = {mesh.points[c[0]], mesh.points[c[1]], mesh.points[c[2]]};
    const Vec3 twice = cross(p[1] - p[0], p[2] - p[0]);
    area_vector.push_back(0.5 * twice);
    surface_area += 0.5 * norm(twice);
    for (std::uint32_t v : c) {
      ++fan_begin[v + 2];
      vertex_solid[v] = s.shells[s.triangle_shell[t]].solid;
    }
  }
  for (std::size_t v = 2; v < fan_begin.size(); ++v) fan_begin[v] += fan_begin[v - 1];
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t v : mesh.triangles[t]) fan_triangles[fan_begin[v + 1]++] = t;
  }
  parallel_ranges(threads, mesh.points.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      pseudonormal[v] =
          pseudonormal_of(mesh, static_cast<std::uint32_t>(v), fan(static_cast<std::uint32_t>(v)));
    }
  });
  if (!s.crossings.empty()) {
    find_crossings();
    find_nested(threads);
  }
  for (double v : s.solid_volume) {
    solid_volume.push_back(std::ldexp(v, -3 * s.exponent));
    volume += solid_volume.back();
  }
}

void TreeInput::Data::find_crossings() {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> entries;  // vertex, triangle
  for (const auto& [i, j] : solid.crossings) {
    for (std::uint32_t v : solid.mesh.triangles[i]) entries.emplace_back(v, j);
    for (std::uint32_t v : solid.mesh.triangles[j]) entries.emplace_back(v, i);
  }
  std::sort(entries.begin(), entries.end());
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
  crossing_begin.assign(solid.mesh.points.size() + 1, 0);
  for (const auto& [vertex, triangle] : entries) {
    ++crossing_begin[vertex + 1];
    crossing_triangles.push_back(triangle);
  }
  for (std::size_t v = 1; v < crossing_begin.size(); ++v) crossing_begin[v] += crossing_begin[v - 1];
}

void TreeInput::Data::find_nested(unsigned threads) {
  constexpr double kStep = 1e-7;  // far less than the spacing of any lattice
  const SolidMembership membership(solid.mesh);
  nested.resize(solid.mesh.points.size());
  parallel_ranges(threads, nested.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const double length = norm(pseudonormal[v]);
      if (length == 0) continue;
      nested[v] = membership.contains(solid.mesh.points[v] + (kStep / length) * pseudonormal[v]);
    }
  });
}

TreeInput::TreeInput(const Solid& solid, unsigned threads) : data_(std::make_unique<Data>(solid, threads)) {}
TreeInput::~TreeInput() = default;

double TreeInput::volume_tolerance() const {
  return 1e-9 * data_->volume + kLevelHeight * data_->surface_area;
}

TreeInput::TreeInput(TreeInput&&) noexcept = default;

}  // namespace affskel::core
