#pragma once

#include <string_view>

#include "core/files/file_format.h"
#include "core/files/shape_file.h"

namespace affskel::core {

/// Reads a shape from the bytes of a file.
/// @param extension of the file with its dot, in lower case; without a known one the first bytes decide (PLY,
/// OFF):
///   .csv          header line with x, y, z and any further columns of numbers;
///   .dat          x y z E nx ny nz per row;
///   .xyz          x y z or x y z nx ny nz per row;
///   .off          Geomview OFF text, with or without faces;
///   .ply          ASCII or binary of either byte order, any properties (but those of ply_display.h beside an
///                 E), polygons cut into triangles;
///   .obj          v, f and l, polygons cut, a backslash at a line's end continues it; the rest is
///                 passed over and counted;
///   .stl          text or binary; corners at the same place become one vertex;
///   .vtp          VTK XML PolyData, as text, base64 or raw, not compressed; point arrays become columns (see
///                 columns_of_array), polygons and strips triangles; the rest is passed over.
/// Coordinates and normals are finite.
/// @throws CoreError kBadInput with the line where there is one.
ShapeFile parse_shape(std::string_view extension, std::string_view bytes);

/// The extension, with its dot, that the content of a mesh file stands for: ".ply", ".stl", ".vtp", ".obj",
/// and ".off" for everything else.
std::string_view extension_of_content(std::string_view bytes);

/// A mesh that was read from a file.
struct MeshFile {
  FileFormat format = FileFormat::kOff;
  OffMesh off;
};

/// Reads the mesh of a file that is to bound a solid: .ply, .obj, .stl and .vtp as parse_shape does;
/// everything else is OFF text.
/// @throws CoreError as parse_shape, and when there are no triangles.
MeshFile parse_mesh_file(std::string_view extension, std::string_view bytes);

}  // namespace affskel::core
