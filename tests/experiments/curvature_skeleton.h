#pragma once

#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/mesh.h"
#include "core/solid/betti_numbers.h"

namespace affskel::experiments {

/// A curve skeleton, mesh units.
struct CurveSkeleton {
  std::vector<core::Vec3> points;
  std::vector<core::Segment> segments;
  core::BettiNumbers betti;  ///< of the graph
  double seconds = 0;        ///< wall time
};

/// The mean curvature skeleton of each connected surface of a mesh (Tagliasacchi, Alhashim, Olson and Zhang 2012)
/// as CGAL computes it, with its defaults.
/// @throws std::runtime_error when it does not take the mesh.
CurveSkeleton curvature_skeleton(const core::Mesh& mesh);

}  // namespace affskel::experiments
