#include "core/mesh/map_mesh.h"

#include <string>
#include <utility>

#include "core/base/error.h"

namespace affskel::core {

Mesh map_mesh(const AffineMap& map, const Mesh& mesh) {
  require_regular(map);
  Mesh result = mesh;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const Vec3 p = result.points[v] = map(mesh.points[v]);
    if (!is_finite(p)) {
      refuse("the map takes vertex " + std::to_string(v) + " out of the range of a double");
    }
  }
  if (determinant(map) < 0) {
    for (Triangle& t : result.triangles) std::swap(t[1], t[2]);
  }
  return result;
}

}  // namespace affskel::core
