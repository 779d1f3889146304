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
  v.strength = 1 / mean(1 / a.strength, 1 / b.strength);
  v.ratio = mean(a.ratio, b.ratio);
  v.roundness = mean(a.roundness, b.roundness);
  v.area = mean(a.area, b.area);
  v.normal_a = unit(mean(a.normal_a, turned ? b.normal_b : b.normal_a));
  v.normal_b = unit(mean(a.normal_b, turned ? b.normal_a : b.normal_b));
  return v;
}

}  // namespace affskel::core
