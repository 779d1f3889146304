#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/mesh/mesh.h"
#include "core/text/off_file.h"

namespace affskel::core {

/// One number per point beside its coordinates, or per triangle: E, H, part of a normal, ...
struct PointColumn {
  std::string name;
  bool whole = false;  ///< meant for whole numbers, such as an index
  std::vector<double> values;
};

/// A file of points, or of triangles and curves: a skeleton, a field, a mesh, a surface.
struct ShapeFile {
  std::string path;
  OffMesh off;  ///< without triangles and segments: points alone; the lines only where the format has them
  std::vector<Segment> segments;     ///< of curves
  std::vector<PointColumn> columns;  ///< one value per point each
  std::vector<PointColumn>
      face_columns;                  ///< one value per triangle each; kept by .ply and .vtp alone, not read
  std::vector<std::uint32_t> quads;  ///< while it is read: first triangles of the faces with four corners

  const Mesh& mesh() const { return off.mesh; }
  /// Be it of curves alone.
  bool is_surface() const { return !off.mesh.triangles.empty() || !segments.empty(); }
  /// The column of this name, nullptr when there is none.
  const PointColumn* column(std::string_view name) const {
    const auto found =
        std::find_if(columns.begin(), columns.end(), [&](const PointColumn& c) { return c.name == name; });
    return found == columns.end() ? nullptr : &*found;
  }
};

/// A shape of a mesh alone, without a file.
inline ShapeFile shape_of(Mesh mesh) {
  ShapeFile shape;
  shape.off.mesh = std::move(mesh);
  return shape;
}

}  // namespace affskel::core
