#include "core/mesh/unused_points.h"

#include "core/base/none.h"

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

Mesh numbered_by_first_use(const Mesh& mesh) {
  std::vector<std::uint32_t> number(mesh.points.size(), kNone);
  Mesh out;
  out.triangles = mesh.triangles;
  for (Triangle& t : out.triangles) {
    for (std::uint32_t& v : t) {
      if (number[v] == kNone) {
        number[v] = static_cast<std::uint32_t>(out.points.size());
        out.points.push_back(mesh.points[v]);
      }
      v = number[v];
    }
  }
  return out;
}

}  // namespace affskel::core
