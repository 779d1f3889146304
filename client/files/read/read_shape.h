#pragma once

#include <string>
#include <string_view>

#include "client/base/shape_file.h"

namespace affskel::client {

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
