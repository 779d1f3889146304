#pragma once

#include <cstdint>
#include <span>

#include "core/base/vec3.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid_membership.h"

namespace affskel::core {

struct ChanceLevelOptions {
  double radius = 0.86602540378443864676;  ///< in units of the spacing; sqrt(3)/2, half a voxel's diagonal
  std::uint32_t draws = 20000;             ///< standard error of the result at most 0.36 %
  std::uint64_t seed = 1;
};

/// The chance level at a radius: the share of the solid's inside within it of the skeleton.  Estimated from
/// points drawn uniformly from the voxels of the sample points (equally many from each, to one; a seeded
/// generator), those outside the solid dropped; sample points themselves lie too far apart.  Without a
/// lattice, or for all radii at once: interior_points.h.
/// @param skeleton in coordinates of the lattice's frame (see frame_field.h), mesh units; not empty.
/// @param solid of the lattice, in scaled coordinates.
/// @return 0 .. 1; 0 when no draw falls inside.
double chance_level(const Lattice& lattice, const SolidMembership& solid, std::span<const Vec3> skeleton,
                    const ChanceLevelOptions& options = {});

}  // namespace affskel::core
