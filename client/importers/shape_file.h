#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/mesh/mesh.h"
#include "core/text/off_file.h"

namespace affskel::client {

/// One number per point beside its coordinates: E, H, part of a normal, ...
struct PointColumn {
  std::string name;
  bool whole = false;  ///< meant for whole numbers, such as an index
  std::vector<double> values;
};

/// A file of points or of triangles: a skeleton, a field, a mesh, a surface.
struct ShapeFile {
  std::string path;
  core::OffMesh off;  ///< triangles empty: points alone; the lines only where the format has them
  std::vector<PointColumn> columns;  ///< one value per point each
  std::vector<std::uint32_t> quads;  ///< while it is read: first triangles of the faces with four corners

  const core::Mesh& mesh() const { return off.mesh; }
  bool is_surface() const { return !off.mesh.triangles.empty(); }
  /// The column of this name, nullptr when there is none.
  const PointColumn* column(std::string_view name) const;
};

/// Reads by the extension, whatever its case; without a known one by the first bytes (PLY, OFF):
///   .csv          header line with x, y, z and any further columns of numbers;
///   .dat          x y z E nx ny nz per row;
///   .xyz          x y z or x y z nx ny nz per row;
///   .off          Geomview OFF text, with or without faces;
///   .ply          ASCII or binary of either byte order, any properties, polygons cut into triangles;
///   .obj          v and f, polygons cut; the rest is passed over;
///   .stl          text or binary; corners at the same place become one vertex;
///   .vtp          VTK XML PolyData, as text, base64 or raw, not compressed; point arrays become columns (see
///                 columns_of_array), polygons and strips triangles; the rest is passed over.
/// Coordinates and normals are finite.
/// @throws ClientError kBadInput with the line where there is one; kLimit when the file is too large.
ShapeFile read_shape(const std::string& path);

/// The same for bytes that came from `path`.
ShapeFile parse_shape(const std::string& path, std::string_view bytes);

}  // namespace affskel::client
