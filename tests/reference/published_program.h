#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::reference {

struct PublishedOptions {
  double spacing = 0;                    ///< dT: of the sample points, mesh units, > 0
  double step = 0;                       ///< dD: by which planes advance, mesh units, > 0
  std::vector<std::uint32_t> triangles;  ///< those to work through; empty: all.  With an evenly spread part
                                         ///< of them a benchmark can time a run and scale it up
  bool every_point = true;  ///< look at every plane which of all the points under it the component holds, as
                            ///< listed (step 4.3.6.2, hence the published L R N^2); false: only at those
                            ///< passed in the last step.  The field is the same, the time is not
  std::uint64_t seed = 1;   ///< of the random rays; decides nothing but which rays are used up
};

/// What the published program computes, per sample point in lattice order (x slowest, z fastest).
struct PublishedField {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<core::Vec3> points;       ///< inside the solid, mesh units
  std::vector<double> erosion;          ///< E, mesh units cubed; +infinity where no plane passed
  std::vector<std::uint32_t> triangle;  ///< whose normal attains E; kNone where no plane passed
  double points_s = 0;                  ///< wall time of generating the points, seconds
  double erosion_s = 0;                 ///< wall time of all the rest, seconds
  std::uint64_t planes = 0;             ///< planes cut
};

/// The affine erosion as published: S. Zografos, "Affine invariant 3D skeletons" (UCL, 2003), section 3.3,
/// after Betelu et al.  The baseline of the speed tables: faithful in method and complexity (N triangles, L
/// planes per triangle, R points: O(N^2) per plane for the components, O(N) per point and plane), not tuned.
///
/// Per triangle: a plane through its centre of mass x_i with its inward normal n_i advances by dD; the
/// surface is cut and reconstructed; components are found by comparing triangle sides; the one that holds the
/// advanced centre x_i + l dD n_i (random rays, barycentric test) has its volume computed by the boundary
/// integral of the open polyhedron; sample points in it that the plane has passed in this step get the volume
/// interpolated linearly between the two planes, when it is less than what they have.  The planes stop at
/// v0/2 or when x_i has left the solid for the last time; while it is outside they are skipped up to its next
/// entry.  Points between the last plane before an exit and the exit get nothing from this triangle.
///
/// Where the text is silent: points are a lattice centred on the bounding box, none in its middle planes,
/// as the core's.  Planes at x_i or at an entry are put 1e-9 of the solid's size further in, where the
/// component is defined.  A ray from x_i that grazes a side is moved aside within the triangle.  An inner
/// surface (of a cavity or of a dent seen from within) is given to the component that holds it, without which
/// volumes would be wrong.
///
/// @param mesh closed, manifold, outward-oriented, not crossing itself; triangles without area are skipped.
/// @throws std::invalid_argument when spacing or step is not finite and > 0 or a triangle is out of range.
PublishedField published_program(const core::Mesh& mesh, const PublishedOptions& options);

}  // namespace affskel::reference
