#include "core/contour/sheet_mesh.h"

#include "core/base/unit.h"

namespace affskel::core {

std::vector<Vec3> positions(const SheetMesh& sheet) {
  std::vector<Vec3> places;
  places.reserve(sheet.vertices.size());
  for (const SheetVertex& vertex : sheet.vertices) places.push_back(vertex.position);
  return places;
}

Mesh mesh_of(const SheetMesh& sheet) {
  return {positions(sheet), sheet.triangles};
}

SheetVertex between(const SheetVertex& a, const SheetVertex& b, double t) {
  const auto mean = [t](const auto& from, const auto& to) { return (1 - t) * from + t * to; };
  const bool turned = dot(a.normal_a - a.normal_b, b.normal_a - b.normal_b) < 0;
  SheetVertex v;
  v.position = mean(a.position, b.position);
  v.point = a.point;
  v.erosion = mean(a.erosion, b.erosion);
  v.strength = mean(a.strength, b.strength);
  v.ratio = mean(a.ratio, b.ratio);
  v.roundness = mean(a.roundness, b.roundness);
  v.area = mean(a.area, b.area);
  v.normal_a = unit(mean(a.normal_a, turned ? b.normal_b : b.normal_a));
  v.normal_b = unit(mean(a.normal_b, turned ? b.normal_a : b.normal_b));
  return v;
}

void drop_unused_vertices(SheetMesh& mesh) {
  constexpr std::uint32_t kUnused = 0xFFFFFFFFU;
  std::vector<std::uint32_t> index(mesh.vertices.size(), kUnused);
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) index[corner] = 0;
  for (const auto& segment : mesh.segments)
    for (const std::uint32_t end : segment) index[end] = 0;
  std::uint32_t kept = 0;
  for (std::uint32_t v = 0; v < index.size(); ++v) {
    if (index[v] == kUnused) continue;
    mesh.vertices[kept] = mesh.vertices[v];
    mesh.part[kept] = mesh.part[v];
    index[v] = kept++;
  }
  mesh.vertices.resize(kept);
  mesh.part.resize(kept);
  for (Triangle& triangle : mesh.triangles)
    for (std::uint32_t& corner : triangle) corner = index[corner];
  for (auto& segment : mesh.segments)
    for (std::uint32_t& end : segment) end = index[end];
}

}  // namespace affskel::core
