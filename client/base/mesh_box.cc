#include "client/base/mesh_box.h"

#include <algorithm>

namespace affskel::client {

using core::Vec3;

double Box::longest_side() const {
  const Vec3 sides = size();
  return std::max({sides.x, sides.y, sides.z});
}

void Box::add(const Vec3& point) {
  low = {std::min(low.x, point.x), std::min(low.y, point.y), std::min(low.z, point.z)};
  high = {std::max(high.x, point.x), std::max(high.y, point.y), std::max(high.z, point.z)};
}

Box mesh_box(const core::Mesh& mesh) {
  Box box{mesh.points.at(0), mesh.points.at(0)};
  for (const Vec3& point : mesh.points) box.add(point);
  return box;
}

}  // namespace affskel::client
