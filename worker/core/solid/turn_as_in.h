#pragma once

#include "core/mesh/mesh.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// Turns the triangles of a mesh as its solid has them: those of solids outward, of cavities inward.
/// @param solid make_solid(mesh).
/// @return false, and nothing is turned, where the solid has not all of the mesh's triangles.
bool turn_as_in(const Solid& solid, Mesh& mesh);

}  // namespace affskel::core
