#pragma once

#include <cstdint>

#include "core/mesh.h"

namespace affskel::core {

/// Closed, outward-oriented, manifold test shapes.  All are functions of their arguments alone.  All
/// throw CoreError kBadInput when an argument is out of range.

/// Torus around the z axis: R = `major_radius` > r = `minor_radius` > 0, exactly `triangles` triangles
/// (even, >= 18; 2 m n with m segments around the axis and n around the tube, chosen so that m n =
/// triangles / 2 and the triangles are as regular as that allows).
Mesh make_torus(double major_radius, double minor_radius, std::uint32_t triangles);

/// Geodesic sphere about the origin: the icosahedron's faces cut frequency^2-fold, 20 f^2 triangles,
/// the least that is >= `at_least_triangles`; vertices on the sphere of the given radius.
Mesh make_sphere(double radius, std::uint32_t at_least_triangles);

/// The sphere's triangles, scaled to semi-axes a, b, c.
Mesh make_ellipsoid(double a, double b, double c, std::uint32_t at_least_triangles);

/// Axis-parallel box [0,a]x[0,b]x[0,c], each face cut into 2 `divisions`^2 triangles.
Mesh make_box(double a, double b, double c, std::uint32_t divisions = 1);

/// Right prism over a regular polygon of `segments` >= 3 sides round the z axis, z in [0, height].
Mesh make_cylinder(double radius, double height, std::uint32_t segments);

/// Pyramid over a regular polygon of `segments` >= 3 sides, base at z = 0, tip at z = height.
Mesh make_cone(double radius, double height, std::uint32_t segments);

/// Regular tetrahedron with the given edge, centred at the origin.
Mesh make_tetrahedron(double edge);

}  // namespace affskel::core
