#include "client/base/mesh_box.h"

#include <algorithm>

namespace affskel::client {

using core::Vec3;

Box mesh_box(const core::Mesh& mesh) {
  Box box{mesh.points.at(0), mesh.points.at(0)};
  for (const Vec3& p : mesh.points) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

}  // namespace affskel::client
