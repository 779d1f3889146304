#pragma once

#include <string>
#include <vector>

#include "client/files/write/armature.h"
#include "client/files/write/shape_writer.h"

namespace affskel::client {

/// Writes a solid with its armature as binary glTF 2.0: the surface as a mesh with a skin, the joints named
/// "part 3.0", "part 3.1", ... along each part, which counts from 1.  glTF's up is +y and that of most bodies here +z: a
/// root node turns them, so that programs whose up is +z (Blender) show the mesh's own coordinates.  Single precision,
/// about the middle of the box.
/// @param comments become the asset's "extras".
/// @throws ClientError kLimit when the file would be larger than the 4 GB that the format can hold.
void write_glb(const LimbedSurface& solid, const std::vector<std::string>& comments, const WriteBytes& write);

}  // namespace affskel::client
