#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::reference {

/// Building blocks of the published program (Zografos 2003, section 3.3): cut and reconstruct, connected
/// components, containment by random rays, the boundary integral.

/// The half space {y : d.y <= height}, d of unit length.
struct Plane {
  core::Vec3 d;
  double height = 0;
};

/// What a cut leaves of a surface: open where the plane was.
struct OpenSurface {
  std::vector<core::Vec3> points;         ///< the mesh's, then those on cut edges
  std::vector<core::Triangle> triangles;  ///< indices into points
};

/// Cuts every triangle by the plane and keeps what is below (figure 3.9: the triangle is kept, discarded, or
/// reconstructed as one or two).  A vertex within `tolerance` of the plane lies on it; a triangle in the
/// plane is kept.  Both triangles of an edge get the same new vertex.  O(N).
OpenSurface cut_and_reconstruct(const core::Mesh& mesh, const Plane& plane, double tolerance);

/// Connected components: triangles that share a side, found as published by comparing the sides of all
/// triangles with those of each one that is reached.  O(N^2).
std::vector<std::vector<core::Triangle>> components(const std::vector<core::Triangle>& triangles);

/// Boundary integral 1/3 sum (c_k - p).S_k, c_k the triangles' centres and S_k their outward area vectors:
/// the volume of the polyhedron that the triangles and a flat lid enclose, p being any point of the lid's
/// plane.
double boundary_integral(const std::vector<core::Vec3>& points, const std::vector<core::Triangle>& triangles,
                         const core::Vec3& p);

/// A ray and what a test found.
struct RayHit {
  bool grazes = false;  ///< within 1e-9 of a side, in barycentric coordinates: the ray decides nothing
  double distance = 0;  ///< along the ray, in lengths of its direction
};

/// Where the ray meets the triangle (barycentric test of Moeller & Trumbore 1997); nothing when it misses.
std::optional<RayHit> meet(const core::Vec3& origin, const core::Vec3& ray, const core::Vec3& a,
                           const core::Vec3& b, const core::Vec3& c);

/// Whether x lies inside the surface: a random ray crosses it an odd number of times.  A ray that grazes a
/// side is replaced by another one.  With a plane the surface may be open there, x must not lie above it,
/// and rays point away from it, so that none passes through the missing lid.  A point on a side is outside.
/// O(N).
bool contains(const std::vector<core::Vec3>& points, const std::vector<core::Triangle>& triangles,
              const core::Vec3& x, const Plane* plane, std::mt19937_64& random);

}  // namespace affskel::reference
