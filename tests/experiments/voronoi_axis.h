#pragma once

#include <cstddef>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/mesh.h"

namespace affskel::experiments {

/// The inner poles of a closed surface: of each of its samples the Voronoi vertex inside the solid that is farthest from
/// it.  They lie on the medial axis in the limit of dense samples, and are the vertices of the power shape (Amenta, Choi
/// and Kolluri, *The power crust, unions of balls, and the medial axis transform*, 2001).
/// @param samples spread evenly over the surface, > 0. @return mesh units, each once.
std::vector<core::Vec3> inner_poles(const core::Mesh& mesh, std::size_t samples);

/// The surface in triangles of nearly equal sides, half as long as its mean edge (Botsch and Kobbelt 2004), by CGAL.
core::Mesh remeshed_isotropically(const core::Mesh& mesh);

}  // namespace affskel::experiments
