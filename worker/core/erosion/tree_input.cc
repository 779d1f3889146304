#include "core/erosion/tree_input.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/plain_math.h"
#include "core/spatial/axis_rays.h"
#include "core/spatial/locality_order.h"

namespace affskel::core {
namespace {

Vec3 pseudonormal_of(const Mesh& mesh, std::uint32_t vertex, std::span<const std::uint32_t> fan) {
  Vec3 sum;
  for (std::uint32_t t : fan) {
    const Triangle& c = mesh.triangles[t];
    const std::size_t i = c[0] == vertex ? 0 : c[1] == vertex ? 1 : 2;
    const Vec3 &p = mesh.points[vertex], &q = mesh.points[c[(i + 1) % 3]], &r = mesh.points[c[(i + 2) % 3]];
    const Vec3 twice = cross(q - p, r - p);
    const double length = norm(twice);
    // Angles not by libm: they decide which side of a vertex the solid lies on.
    if (length != 0) sum = sum + (plain_angle(length, dot(q - p, r - p)) / length) * twice;
  }
  return sum;
}

std::vector<Vec3> centroids(const Mesh& mesh) {
  std::vector<Vec3> result;
  result.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    result.push_back((1.0 / 3) * (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]));
  }
  return result;
}

std::vector<std::uint32_t> inverse(const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> place(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
  return place;
}

Mesh in_order(const Mesh& mesh, const std::vector<std::uint32_t>& vertices,
              const std::vector<std::uint32_t>& triangles) {
  const std::vector<std::uint32_t> place = inverse(vertices);
  Mesh result;
  result.points.reserve(vertices.size());
  for (const std::uint32_t v : vertices) result.points.push_back(mesh.points[v]);
  result.triangles.reserve(triangles.size());
  for (const std::uint32_t t : triangles) {
    const Triangle& c = mesh.triangles[t];
    result.triangles.push_back({place[c[0]], place[c[1]], place[c[2]]});
  }
  return result;
}

}  // namespace

TreeInput::TreeInput(const Solid& s, unsigned threads)
    : original_vertex(locality_order(s.mesh.points)),
      original_triangle(locality_order(centroids(s.mesh))),
      mesh(in_order(s.mesh, original_vertex, original_triangle)),
      pseudonormal(mesh.points.size()),
      fans(holders(mesh.points.size(), mesh.triangles)),
      vertex_solid(mesh.points.size(), 0),
      rays(mesh, threads) {
  area_vector.reserve(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    const Vec3 twice = twice_area(mesh, c);
    area_vector.push_back(0.5 * twice);
    surface_area += 0.5 * norm(twice);
    for (std::uint32_t v : c) vertex_solid[v] = s.solid_of(original_triangle[t]);
  }
  parallel_ranges(threads, mesh.points.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      pseudonormal[v] =
          pseudonormal_of(mesh, static_cast<std::uint32_t>(v), fan(static_cast<std::uint32_t>(v)));
    }
  });
  if (!s.crossings.empty()) {
    find_crossings(s);
    find_nested(threads);
  }
  for (double v : s.solid_volume) {
    solid_volume.push_back(s.scaled(v));
    volume += solid_volume.back();
  }
}

void TreeInput::find_crossings(const Solid& solid) {
  const std::vector<std::uint32_t> place = inverse(original_triangle);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> entries;  // both ways
  for (const auto& [i, j] : solid.crossings) {
    entries.emplace_back(place[i], place[j]);
    entries.emplace_back(place[j], place[i]);
  }
  std::sort(entries.begin(), entries.end());
  crosses.assign(mesh.points.size(), 0);
  for (const auto& [triangle, other] : entries) {
    for (std::uint32_t v : mesh.triangles[triangle]) crosses[v] = 1;
  }
  crossings = {mesh.triangles.size(), [&](const auto& put) {
                 for (const auto& [triangle, other] : entries) put(triangle, other);
               }};
}

void TreeInput::find_nested(unsigned threads) {
  constexpr double kOffset = 1e-7;        // far less than the spacing of any lattice
  const AxisRays along_x(mesh, threads);  // whatever the mesh: fields keep their bytes
  nested.resize(mesh.points.size());
  parallel_ranges(threads, nested.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const double length = norm(pseudonormal[v]);
      if (length == 0) continue;
      nested[v] = along_x.shoot(mesh.points[v] + (kOffset / length) * pseudonormal[v], 0, true).winding > 0;
    }
  });
}

}  // namespace affskel::core
