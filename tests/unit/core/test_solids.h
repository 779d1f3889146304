#pragma once

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Small solids that the library's shapes do not offer, for the tests.

/// The mesh scaled, then moved.
Mesh moved(Mesh mesh, const Vec3& by, double scale = 1);

/// The mesh turned inside out.
Mesh reversed(Mesh mesh);

/// Both meshes as one, without common vertices.
Mesh joined(Mesh a, const Mesh& b);

/// The box [0, a] x [0, b] x [0, c] made of two that pass through each other: between c/2 - 1.7 and c/2 + 1.7
/// they overlap, and the upper one is narrower by 0.01 on every side.
Mesh overlapping_boxes(double a, double b, double c);

/// One surface that overlaps itself: a square rod, 1 thick, bent to a coil of one and a half turns about the z axis, each 0.3
/// above the last, 3 to 4 from it.
Mesh make_coil();

/// The mesh turned about an axis in no special position, then every coordinate moved by up to +-noise.
Mesh shaken(Mesh mesh, double noise, std::uint64_t seed);

/// A ball of radius 3 with a spherical cavity of radius 1 about (0.5, 0, 0).
Mesh hollow_ball();

/// A cup: outer radius 2, height 3, inner radius 1.5, floor 1 thick, open upwards; `segments` sides.
/// Its inside has an inner minimum for upward directions.
Mesh cup(std::uint32_t segments);

/// `teeth` square prongs, each 1 wide, 1 apart and 3 high, on a bar 1 high and deep: many minima downwards.
Mesh comb(std::uint32_t teeth);

}  // namespace affskel::core
