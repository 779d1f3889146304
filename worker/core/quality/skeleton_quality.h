#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/published_threshold.h"
#include "core/erosion/directions.h"
#include "core/lattice/lattice.h"
#include "core/mesh/mesh.h"
#include "core/quality/advice.h"
#include "core/shocks/shock_operator.h"
#include "core/solid/betti_numbers.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// What a skeleton is like.  Distances in the coordinates of the lattice's frame, mesh units.
struct SkeletonQuality {
  std::uint64_t points = 0;  ///< sample points kept; of a sheet its vertices
  BettiNumbers skeleton;     ///< of the union of the points' voxels; of a sheet its own
  double inside_share = 1;   ///< of the points inside the solid, 0 .. 1, tested by rays; below 1 is a bug
  double mean_thickness =
      0;               ///< in voxels (see voxel_thickness.h); 1 for sheets and curves; 0 without points
  BettiNumbers solid;  ///< for comparison
  double other_threshold = 0;  ///< the next higher one of the ladder
  /// Hausdorff distances: the largest distance of a point of this skeleton from the one of `other_threshold`,
  /// and back.  Of skeletons by the same H the higher threshold's is a subset, and the way back is 0.  Absent
  /// when one of them is empty.
  std::optional<double> hausdorff_there, hausdorff_back;
  double chance_level = 0;  ///< at half a voxel's diagonal, see chance_level.h
  Advice advice;            ///< why it is empty and what to try
};

struct SkeletonQualityOptions {
  ShockOperator shock_operator = ShockOperator::kZuckerHummel;  ///< that gave H
  double threshold = base::kZuckerHummelThreshold;              ///< of the skeleton
  std::size_t more_directions = 0;                              ///< see empty_skeleton_advice()
};

/// The quality of the skeleton of the points with |H| > threshold.
/// Time O(R + n log n + N log N) for R sample points, n kept, N triangles, and the lattice's rows.
/// @param divergence H per sample point.
/// @throws CoreError kBadInput when the threshold is not a finite number > 0.
SkeletonQuality skeleton_quality(const Solid& solid, const Lattice& lattice, const OptimalDirections& optimal,
                                 const std::vector<double>& divergence,
                                 const SkeletonQualityOptions& options = {});

/// Curves that belong to a sheet: two of its vertices each.
using Segments = std::span<const Segment>;

struct SheetQualityOptions {
  Segments segments;            ///< of the sheet's curves
  double other_threshold = 0;   ///< that `other` was made with
  const Mesh* other = nullptr;  ///< the sheet at the next higher threshold; none: no Hausdorff distances
  Advice advice_if_empty;       ///< see empty_sheet_advice
  const std::vector<Vec3>* points = nullptr;  ///< the shocks that the sheet was laid through, likewise in u
};

/// The quality of a triangulated sheet (`chords`), or of sheets and curves (`ridge`).  Its points are the
/// shocks when they are given, else its vertices, one per lattice cell that the sheet passes through;
/// distances are between vertices.
/// @param sheet vertices in coordinates of the lattice's frame (u, see frame_field.h), mesh units; triangles
///   distinct, each with three distinct corners.
SkeletonQuality sheet_quality(const Solid& solid, const Lattice& lattice, const Mesh& sheet,
                              const SheetQualityOptions& options = {});

}  // namespace affskel::core
