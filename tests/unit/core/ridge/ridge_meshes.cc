#include "core/ridge/ridge_meshes.h"

namespace affskel::core {

SheetMesh square(std::uint32_t n, const std::function<double(double, double)>& strength) {
  SheetMesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      SheetVertex v;
      v.position = {double(i), double(j), 0};
      v.strength = strength(i, j);
      v.erosion = 1;
      v.normal_a = {0, 0, 1};
      v.normal_b = {0, 0, -1};
      mesh.vertices.push_back(v);
      mesh.part.push_back(0);
    }
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t at = j * (n + 1) + i;
      mesh.triangles.push_back({at, at + 1, at + n + 2});
      mesh.triangles.push_back({at, at + n + 2, at + n + 1});
    }
  }
  return mesh;
}

SheetMesh part_of_square(std::uint32_t n, const std::function<bool(double, double)>& wanted) {
  SheetMesh mesh = square(n, [](double, double) { return 10; });
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    Vec3 middle;
    for (const std::uint32_t corner : t) middle = middle + (1.0 / 3) * mesh.vertices[corner].position;
    return !wanted(middle.x, middle.y);
  });
  drop_unused_vertices(mesh);
  return mesh;
}

RidgeCurve line(double low, double high, double radius) {
  RidgeCurve curve;
  for (double x = low; x <= high; x += 1) {
    SheetVertex v;
    v.position = {x, 15.1, 0.2};
    v.strength = 7;
    curve.vertices.push_back(v);
    curve.radius.push_back(radius);
  }
  return curve;
}

SheetTopology topology(const SheetMesh& mesh) {
  Mesh plain;
  for (const SheetVertex& v : mesh.vertices) plain.points.push_back(v.position);
  plain.triangles = mesh.triangles;
  return sheet_topology(plain, mesh.segments);
}

}  // namespace affskel::core
