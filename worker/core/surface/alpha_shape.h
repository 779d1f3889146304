#pragma once

#include <span>

#include "core/mesh/mesh.h"

namespace affskel::core {

struct AlphaShapeOptions {
  double alpha = 0;    ///< squared radius of the alpha shape, > 0; 0 = 3 * spacing^2: the square of a
                       ///< voxel's diagonal, so that lattice neighbours (26) are always joined
  double spacing = 0;  ///< lattice spacing; required when alpha is 0, welcome otherwise (see below)
};

/// The triangles of the alpha shape of `points`: facets of the boundary of its solid part, seen
/// counter-clockwise from outside, and facets that stand alone (a sheet one point thick has no solid
/// part), each once, the largest component of their normals > 0.  Vertices are those points that a
/// triangle uses, in the order of `points`; a point given more than once counts as its first copy.
/// Points on one plane give their Delaunay triangles of squared circumradius <= alpha; fewer than three
/// points, or points on one line, give no triangle.
///
/// Alpha shape of Edelsbrunner & Muecke (1994) on CGAL's Delaunay triangulation, exact predicates; radii
/// are compared with a relative margin of 1e-9, so that a radius equal to alpha counts as below it.  When
/// `spacing` is given and all points lie on an axis-parallel lattice of that spacing (to 1e-6 of it), the
/// shape is that of the undistorted lattice: rounding of the coordinates then decides nothing.
/// The result depends on the points and their order alone.
/// @throws CoreError kBadInput when alpha and spacing are both 0, when one is negative or not finite, or
///   when a coordinate is not finite.
Mesh alpha_shape(std::span<const Vec3> points, const AlphaShapeOptions& options);

}  // namespace affskel::core
