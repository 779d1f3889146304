#include "core/mesh/unused_points.h"

namespace affskel::core {

std::vector<std::uint32_t> drop_unused_points(Mesh& mesh) {
  std::vector<std::uint32_t> name(mesh.points.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) name[v] = 1;
  }
  std::vector<std::uint32_t> dropped;
  std::uint32_t kept = 0;
  for (std::uint32_t v = 0; v < name.size(); ++v) {
    if (name[v] == 0) {
      dropped.push_back(v);
      continue;
    }
    mesh.points[kept] = mesh.points[v];
    name[v] = kept++;
  }
  mesh.points.resize(kept);
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = name[v];
  }
  return dropped;
}

}  // namespace affskel::core
