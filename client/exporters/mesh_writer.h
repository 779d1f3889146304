#pragma once

#include <functional>
#include <string>
#include <vector>

#include "client/exporters/format.h"
#include "core/mesh.h"

namespace affskel::client {

/// Parses a SURFACE artefact.
/// @throws ClientError kInternal when an index is out of range.
core::Mesh parse_surface(const std::string& bytes);

/// Writes a mesh in one of surface_formats(): .off and .obj as text that reads back exactly, .ply binary with
/// double coordinates, .stl binary (single precision, which is all that STL has).
/// @param comments lines for formats that have comments (PLY, OBJ), without line breaks.
/// @param write takes the bytes, piece by piece.
/// @throws ClientError kLimit when the mesh has more elements than the format can count.
void write_mesh(FileFormat format, const core::Mesh& mesh, const std::vector<std::string>& comments,
                const std::function<void(std::string_view)>& write);

}  // namespace affskel::client
