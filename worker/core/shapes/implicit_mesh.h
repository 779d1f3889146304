#pragma once

#include <functional>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// A function whose zero set is meshed: < 0 inside, > 0 outside, continuous, with Lipschitz constant 1
/// (a distance, or an underestimate of one), so that |f(x)| is a radius free of surface.
using ImplicitFunction = std::function<double(const Vec3&)>;

struct ImplicitMeshOptions {
  Vec3 low, high;      ///< a box; the mesh is open where the zero set leaves it
  double spacing = 1;  ///< edge of the cubes of the lattice, > 0
};

/// The zero set of `f` by marching tetrahedra (Doi & Koide 1991) on the body-centred cubic lattice, whose
/// tetrahedra are all alike and nearly regular.  Manifold and outward by construction, whatever `f` is, and
/// closed when the zero set lies in the box with a margin of at least `spacing`; a function of its arguments
/// alone.  Only cubes that the Lipschitz bound cannot rule out are looked at, so the cost follows the
/// surface, not the box.  Vertices lie on lattice edges near the zero set; see fair_onto.
Mesh mesh_zero_set(const ImplicitFunction& f, const ImplicitMeshOptions& options);

/// Evens out a mesh of the zero set of `f`: each round moves every vertex half way to the mean of its
/// neighbours and back onto the zero set along the gradient.  In a groove that may be the other wall, which makes it cross
/// itself.
/// @param step length used for the difference quotients of the gradient, mesh units.
void fair_onto(const ImplicitFunction& f, double step, int rounds, Mesh& mesh);

}  // namespace affskel::core
