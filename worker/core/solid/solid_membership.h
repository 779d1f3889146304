#pragma once

#include <initializer_list>

#include "core/mesh/box.h"
#include "core/mesh/mesh.h"
#include "core/spatial/axis_rays.h"

namespace affskel::core {

/// Whether points lie in the solid that a mesh bounds: the winding number of the surface about the point, by a ray to the
/// nearer side of its box, along x, or another axis on which clearly fewer triangles lie behind each other (see AxisRays).
/// What is exactly on the surface may be in or out.  Independent of the scan conversion that chooses the sample points, and
/// so can check it.  Keeps a reference to the mesh.  Immutable after construction; queries from several threads are safe.
class SolidMembership {
 public:
  /// On up to `threads` threads.  @param mesh closed, outward-oriented.
  explicit SolidMembership(const Mesh& mesh, unsigned threads = 1);

  /// Whether the surface winds round q at least once, or does so round one of the eight points at
  /// +-`tolerance` from q along each axis: a sample point on the surface belongs to the solid.
  bool contains(const Vec3& q, double tolerance = 0) const {
    if (winding_number(q) > 0) return true;
    if (!(tolerance > 0)) return false;
    for (const double x : {-tolerance, tolerance})
      for (const double y : {-tolerance, tolerance})
        for (const double z : {-tolerance, tolerance})
          if (winding_number(q + Vec3{x, y, z}) > 0) return true;
    return false;
  }

  /// How often the surface winds round q; of a place on it, what the ray leaves out or not.
  int winding_number(const Vec3& q) const;

 private:
  AxisRays rays_;
  Box box_;
  int axis_;
};

}  // namespace affskel::core
