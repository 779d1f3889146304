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

/// The surface between the nodes at which a function is negative, the inner ones, and the others.  Its topology is
/// decided by the values at the nodes alone: two inner nodes belong together along an edge of a cube; across a face, of
/// which the others are outer ones, where the mean of its four values is negative; and where this leaves more than one
/// piece of surface in a cube, with its middle where the mean of its eight values is.  The same holds for outer ones with
/// the rest of the signs.  So it is a manifold, parts no solid that hangs together by edges, and joins none that do not
/// touch even at corners of cubes; a mirrored function has the mirrored surface but for the order of vertices.
///
/// It does not cross itself, whatever the function is: a cube's face is met in straight lines between points within its
/// edges.  One closed line on a cube bounds the cone from a place inside, wherever that is: the nearest on the zero set
/// to the mean of the line's points that the cube holds.  More lines bound polygons in the pyramids of the faces over
/// the cube's middle.  A face's line may also be bent to where the way between the apexes on both sides meets the face:
/// that is how edges are turned to make triangles even (Delaunay).  All this holds by 0.05 spacings, which no rounding
/// undoes.
///
/// @param f continuous; positive or 0 at the lattice's outermost nodes, else the mesh is open there.
/// @return closed, outward, in the lattice's coordinates.
Mesh sign_surface(const std::function<double(const Vec3&)>& f, const CubeLattice& lattice,
                  ExecutionContext* context = nullptr);

}  // namespace affskel::core
