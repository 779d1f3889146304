#pragma once

#include <functional>
#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "client/files/format.h"
#include "client/files/write/atomic_file.h"
#include "core/mesh/mesh.h"

namespace affskel::client {

/// A number per vertex, or three (`components`), one vertex after the other.
struct VertexProperty {
  std::vector<std::string> components;  ///< their names
  std::vector<double> values;
};

/// A surface as the server sends it.
struct FetchedSurface {
  core::Mesh mesh;
  std::vector<VertexProperty> properties;  ///< of a sheet of chords
  v1::SkeletonQuality quality;             ///< of a sheet of chords
  double volume = 0;                       ///< of an eroded solid
};

/// Parses a SURFACE or ERODED_SURFACE artefact.
/// @throws ClientError kInternal when an index is out of range or a vertex lacks a property.
FetchedSurface parse_surface(const std::string& bytes);

/// Writes a mesh in one of surface_formats(): .off and .obj as text that reads back exactly, .ply binary with
/// double coordinates and the properties, .vtp with the same as arrays (see write_vtp), .stl binary (single
/// precision, which is all that STL has).
/// Slivers that single precision makes flat are written as they are; the surface stays closed.
/// @param comments lines for formats that have comments (PLY, OBJ, VTP), without line breaks.
/// @param write takes the bytes, piece by piece.
/// @throws ClientError kLimit when the mesh has more elements than the format can count, and for .stl when a
/// coordinate does not fit into single precision or when triangles would become flat in it that hold more
/// than 1e-6 of the area or all the area round a vertex: the mesh or a part of it is too small, or too far
/// from the origin for its size.
void write_mesh(FileFormat format, const core::Mesh& mesh, const std::vector<std::string>& comments,
                const std::function<void(std::string_view)>& write,
                const std::vector<VertexProperty>& properties = {});

/// The same into a file, which the errors then name.
void write_mesh(FileFormat format, const core::Mesh& mesh, const std::vector<std::string>& comments,
                AtomicFile& file, const std::vector<VertexProperty>& properties = {});

}  // namespace affskel::client
