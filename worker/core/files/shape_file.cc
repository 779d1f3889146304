#include "core/files/shape_file.h"

#include <algorithm>
#include <utility>

namespace affskel::core {

const PointColumn* ShapeFile::column(std::string_view name) const {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const PointColumn& c) { return c.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

ShapeFile shape_of(Mesh mesh) {
  ShapeFile shape;
  shape.off.mesh = std::move(mesh);
  return shape;
}

}  // namespace affskel::core
