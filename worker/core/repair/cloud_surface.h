#pragma once

#include <cstdint>
#include <span>

#include "core/base/execution_context.h"
#include "core/base/vec3.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

struct CloudSurface {
  Mesh mesh;               ///< closed, manifold, outward; may have several parts, and cavities
  std::uint64_t lone = 0;  ///< points far from all others, left out
  std::uint64_t used = 0;  ///< points that the surface was laid through: in dense noisy clouds one of several
  double spacing = 0;      ///< mean distance of these to their six nearest, mesh units
  double mean_distance = 0;  ///< of these from the surface, mesh units
  double unseen = 0;         ///< share of the surface that is farther than three spacings from each of them
};

/// The closed surface through points that lie on it but for noise, by Poisson reconstruction (Kazhdan, Bolitho and Hoppe
/// 2006) from normals of fitted quadrics (Cazals and Pouget 2005) that agree along a spanning tree (Hoppe et al. 1992): all
/// of CGAL.  Noise to both sides keeps the volume, whereas a wrap lies round the outermost points.
/// @param points of any order, distances and scale. @throws CoreError kBadInput for fewer than a hundred places, for
///   points in a plane, and where more than a quarter of the surface is unseen; kCancelled.
CloudSurface cloud_surface(std::span<const Vec3> points, ExecutionContext* context = nullptr);

}  // namespace affskel::core
