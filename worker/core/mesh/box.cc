#include "core/mesh/box.h"

#include <algorithm>

namespace affskel::core {

void Box::include(const Box& other) {
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = std::min(low[k], other.low[k]);
    high[k] = std::max(high[k], other.high[k]);
  }
}

Box box_of(const Mesh& mesh, const Triangle& triangle) {
  const auto at = [&](std::size_t corner) {
    const Vec3& p = mesh.points[triangle[corner]];
    return Box{{p.x, p.y, p.z}, {p.x, p.y, p.z}};
  };
  Box box = at(0);
  box.include(at(1));
  box.include(at(2));
  return box;
}

std::vector<Box> boxes_of(const Mesh& mesh) {
  std::vector<Box> boxes;
  boxes.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) boxes.push_back(box_of(mesh, t));
  return boxes;
}

}  // namespace affskel::core
