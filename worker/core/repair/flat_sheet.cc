#include "core/repair/flat_sheet.h"

#include <algorithm>
#include <cmath>

namespace affskel::core {

bool lie_in_a_plane(const Mesh& mesh, const std::vector<std::uint32_t>& points) {
  constexpr double kRounding = 1e-6;  // of the length
  if (points.empty()) return true;
  const Vec3 first = mesh.points[points[0]];
  Vec3 along{}, normal{};
  const auto take_longer = [](Vec3& longest, const Vec3& one) {
    if (norm(one) > norm(longest)) longest = one;
  };
  for (const std::uint32_t v : points) take_longer(along, mesh.points[v] - first);
  for (const std::uint32_t v : points) take_longer(normal, cross(along, mesh.points[v] - first));
  const double thickness = kRounding * norm(along) * norm(normal);
  return std::all_of(points.begin(), points.end(), [&](std::uint32_t v) {
    return std::fabs(dot(normal, mesh.points[v] - first)) <= thickness;
  });
}

bool is_flat_sheet(const Mesh& mesh) {
  std::vector<std::uint32_t> corners;
  for (const Triangle& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
  return lie_in_a_plane(mesh, corners);
}

}  // namespace affskel::core
