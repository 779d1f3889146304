#pragma once

#include <span>

#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

struct AlphaShapeOptions {
  double alpha = 0;    ///< squared radius of the alpha shape, > 0; 0 = 3 * spacing^2: the square of a
                       ///< voxel's diagonal, so that lattice neighbours (26) are always joined
  double spacing = 0;  ///< lattice spacing; required when alpha is 0, welcome otherwise (see below)
  ExecutionContext* context = nullptr;  ///< asked whether to stop
};

/// The triangles of the alpha shape of `points` (Edelsbrunner & Muecke 1994): its regular facets,
/// counter-clockwise seen from outside, and its singular facets (a sheet one point thick has no others), each
/// once, turned so that the largest component of the normal is > 0.  Vertices are those points that a
/// triangle uses, in the order of `points`; a point given more than once counts as its first copy.  Points on
/// one plane give their Delaunay triangles of squared circumradius <= alpha; fewer than three points, or
/// points on one line, give no triangle.
///
/// Radii that equal alpha within 1e-9 count as below it.  When `spacing` is given and all points lie on an
/// axis-parallel lattice of that spacing (to 1e-6 of it), the shape is that of the exact lattice: rounding of
/// the coordinates then decides nothing.  The result depends on the points and their order alone.
/// @throws CoreError kBadInput when alpha and spacing are both 0, when one is negative or not finite, or when
///   a coordinate is not finite; kCancelled.
Mesh alpha_shape(std::span<const Vec3> points, const AlphaShapeOptions& options);

}  // namespace affskel::core
