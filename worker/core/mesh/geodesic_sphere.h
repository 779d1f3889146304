#pragma once

#include <cstdint>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// The regular icosahedron round the origin, edges of length 2: what spheres and sets of directions are
/// subdivisions of.  Faces counter-clockwise seen from outside.
Mesh icosahedron();

/// The unit geodesic sphere: the icosahedron's faces cut frequency^2-fold and their points moved out to
/// distance 1.  20 f^2 triangles, counter-clockwise seen from outside, and 10 f^2 + 2 vertices.  Only
/// + - * / and sqrt are used, so that all machines agree on every bit.
/// @param frequency f, 1 .. 2^14.
Mesh geodesic_sphere(std::uint32_t frequency);

}  // namespace affskel::core
