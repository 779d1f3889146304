#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/execution_context.h"
#include "core/files/read/voxel_parsers.h"
#include "core/files/shape_file.h"

namespace affskel::core {

/// Reads a shape from the bytes of a file: by what their beginning says, and where this says nothing by the
/// extension.
/// @param extension of the file with its dot, in lower case:
///   .csv          header line with x, y, z and any further columns of numbers;
///   .dat          x y z E nx ny nz per row;
///   .xyz          x y z or x y z nx ny nz per row;
///   .off          Geomview OFF, text or binary, with or without faces;
///   .ply          ASCII or binary of either byte order, any properties (but those of ply_display.h beside an
///                 E), polygons cut into triangles; other elements are passed over and counted;
///   .obj          v, f and l, polygons cut, a backslash at a line's end continues it; the rest is
///                 passed over and counted;
///   .stl          text or binary; corners at the same place become one vertex;
///   .vtp          VTK XML PolyData, as text, base64 or raw, not compressed; point arrays become columns (see
///                 columns_of_array), polygons and strips triangles; the rest is passed over;
///   .glb, .gltf   glTF 2.0: the triangles of the scene in its coordinates, not compressed, with all numbers in
///                 the file; corners at the same place become one vertex;
///   .3mf          the triangles of all items that are built, in the file's unit, without objects for support.
/// Coordinates and normals are finite.
/// @throws CoreError kBadInput with the line where there is one; kLimit for what would grow without bound, and for more
///   than 2^28 vertices or triangles.
ShapeFile parse_shape(std::string_view extension, std::string_view bytes);

struct MeshFileOptions {
  std::optional<double> isovalue;       ///< of an image of voxels: at its surface, see isosurface
  ReadBeside beside = {};               ///< of an image of voxels whose numbers are in another file
  ExecutionContext* context = nullptr;  ///< asked whether to stop while the surface of an image is sought
};

/// A mesh that was read from a file.
struct MeshFile {
  std::string format;     ///< off, ply, obj, stl, vtp, glb, gltf, 3mf, xyz, csv, "binary off" or "voxels"
  bool off_text = false;  ///< whether the bytes are OFF text
  OffMesh off;
  std::string told;  ///< of voxels: how the surface was made
};

/// Reads the mesh of a file that is to bound a solid as parse_shape does; what neither content nor extension
/// tells is OFF text.  Of an image of voxels (see parse_voxels) it is the surface at a value.  There may be points alone,
/// which repair_mesh can wrap.
/// @throws CoreError as parse_shape, parse_voxels and isosurface; kBadInput when there is no value for an image of
///   voxels, or one for anything else.
MeshFile parse_mesh_file(std::string_view extension, std::string_view bytes,
                         const MeshFileOptions& options = {});

/// Extensions of the files that triangles are read from; the first is Geomview OFF's.
std::vector<std::string_view> mesh_extensions();

/// Those of points alone that may be those of a surface, see repair_mesh().
std::vector<std::string_view> cloud_extensions();

enum class VoxelFiles {
  kAll,
  kWhole,  ///< but .nhdr and .mhd, whose numbers are in another file
};

/// Those of images of voxels, at whose surface a mesh is made.
std::vector<std::string_view> voxel_extensions(VoxelFiles which = VoxelFiles::kAll);

/// What a compressed file has behind its own, see unpack().
std::vector<std::string_view> packed_extensions();

/// Each behind a blank.
std::string listed(const std::vector<std::string_view>& extensions);

}  // namespace affskel::core
