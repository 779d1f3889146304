#pragma once

#include <array>
#include <cstddef>
#include <functional>

#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Nodes of a lattice of cubes: low + spacing (i, j, k).
struct CubeLattice {
  Vec3 low;
  double spacing = 1;
  std::array<std::size_t, 3> nodes{};  ///< along the axes
};

/// The surface between the nodes at which a function is negative, the inner ones, and the others.
///
/// The values at the nodes alone decide its topology: all along an edge of a cube, in a face and in a cube is inside where
/// the corners are, and outside likewise.  Where inner and outer corners take turns round a face, the inner ones are joined
/// across it where the mean of the four is negative, else the outer ones.  Where there is more than one piece of surface
/// in a cube after that, the mean of the eight says on which side the cube's middle is, which joins corners to it.  That
/// is the topology of a complex of twelve tetrahedra in each cube, over the halves of its faces with a tip in its
/// middle; so the surface is a manifold.  It is nearly always that of the values interpolated linearly along each axis.
///
/// It does not cross itself, whatever the function is.  It meets the faces of cubes in straight lines between points
/// within their edges.  Where these form one closed line on a cube, the cube holds the cone over it from a place inside:
/// that cannot cross itself, as a cube is convex, wherever the place is, which may thus be sought on the zero set.
/// Where they form several, it holds polygons in the pyramids over its faces with their tips in its middle.  A line that
/// is alone in its face, between two cones, may also bend at the way between their apexes, which lies in both cubes: so
/// the edge over it is turned where that is nearer to the zero set.  Vertices keep 0.001 spacings away from what would
/// make this degenerate, so that no rounding undoes it.
///
/// @param f continuous; positive or 0 at the lattice's outermost nodes, else the mesh is open there.
/// @return closed, outward, in the lattice's coordinates; a function of the arguments alone.
Mesh sign_surface(const std::function<double(const Vec3&)>& f, const CubeLattice& lattice,
                  ExecutionContext* context = nullptr);

}  // namespace affskel::core
