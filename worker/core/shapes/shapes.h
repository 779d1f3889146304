#pragma once

#include <cstdint>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Closed, outward-oriented, manifold test shapes.  All are functions of their arguments alone.  All
/// throw CoreError kBadInput when an argument is out of range, with the argument's name and value, and
/// kLimit when more than 2^26 triangles are asked for.  Lengths are in mesh units, finite and > 0.

/// Torus around the z axis: R = `major_radius` > r = `minor_radius` > 0, exactly `triangles` triangles
/// (even, >= 18): 2 m n with m >= 3 segments around the axis and n >= 3 around the tube.  Of the pairs
/// with m n = triangles / 2 the one closest to the smooth torus is taken (least sum of the sagittas
/// r (1 - cos(pi/n)) and (R + r) (1 - cos(pi/m))); 256 triangles are 16 x 8.  A count whose factors only
/// allow a ribbon (say 2 x 3 x a large prime) is refused, and the message names counts that work.
Mesh make_torus(double major_radius, double minor_radius, std::uint32_t triangles);

/// Geodesic sphere about the origin: the icosahedron's faces cut frequency^2-fold, 20 f^2 triangles,
/// the least that is >= `at_least_triangles`; vertices on the sphere of the given radius.
Mesh make_sphere(double radius, std::uint32_t at_least_triangles);

/// The sphere's triangles, scaled to semi-axes a, b, c along x, y, z.
Mesh make_ellipsoid(double a, double b, double c, std::uint32_t at_least_triangles);

/// Axis-parallel box [0,a]x[0,b]x[0,c], each face cut into 2 `divisions`^2 triangles, `divisions` >= 1.
Mesh make_box(double a, double b, double c, std::uint32_t divisions = 1);

/// Right prism over a regular polygon of `segments` >= 3 sides round the z axis, z in [0, height]:
/// 4 `segments` triangles, the two lids being fans about their centres.
Mesh make_cylinder(double radius, double height, std::uint32_t segments);

/// Pyramid over a regular polygon of `segments` >= 3 sides, base at z = 0, tip at z = height:
/// 2 `segments` triangles, the base being a fan about its centre.
Mesh make_cone(double radius, double height, std::uint32_t segments);

/// Regular tetrahedron with the given edge, centred at the origin, one face level and below.
Mesh make_tetrahedron(double edge);

}  // namespace affskel::core
