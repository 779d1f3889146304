#pragma once

#include <span>

#include "core/mesh.h"

namespace affskel::core {

struct AlphaSurfaceOptions {
  double alpha = 0;    ///< squared radius of the alpha shape, > 0; 0 = 3 * spacing^2: the square of a
                       ///< voxel's diagonal, so that lattice neighbours (26) are always joined
  double spacing = 0;  ///< lattice spacing; required when alpha is 0
};

/// The triangles of the alpha shape of `points`: facets of the boundary of its solid part and facets
/// that stand alone (a sheet one point thick has no solid part), each once.  Vertices are those points
/// that a triangle uses.  CGAL Alpha_shape_3 (Edelsbrunner & Muecke 1994), fixed alpha, exact
/// predicates; the order of the output depends on the points alone.
/// @throws CoreError kBadInput when alpha and spacing are both 0 or negative or not finite.
Mesh alpha_surface(std::span<const Vec3> points, const AlphaSurfaceOptions& options);

}  // namespace affskel::core
