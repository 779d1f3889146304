#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include "core/mesh/mesh.h"

namespace affskel::core {

// CGAL's mesh; for sources that need CGAL anyway.

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;

/// @param mesh manifold, its triangles agreeing. @throws CoreError kBadInput when it is not.
SurfaceMesh surface_mesh_of(const Mesh& mesh);

/// Points and triangles in CGAL's order, without what was removed.
Mesh mesh_of(const SurfaceMesh& surface);

}  // namespace affskel::core
