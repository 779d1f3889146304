#pragma once

#include "core/mesh/mesh.h"

namespace affskel::core {

/// The regular icosahedron round the origin, edges of length 2: what spheres and sets of directions are
/// subdivisions of.  Faces counter-clockwise seen from outside.
Mesh icosahedron();

}  // namespace affskel::core
