#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/box.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// The least volume of a solid that can be told from rounding, in scaled coordinates: a share of the cube
/// whose side is about the mesh's longest.
inline constexpr double kMinScaledVolume = 1e-15;

/// The side of a cube of that volume.
inline constexpr double kMinScaledSide = 1e-5;

/// The largest share of the largest solid's volume that a speck may have.
inline constexpr double kSpeckShare = 1e-3;

/// What a connected solid is by itself, in scaled coordinates.
struct SolidSize {
  Box box;
  double volume = 0;  ///< about a corner of its own: that it lies far from the centre takes no digits from it
  double bulk = 0;    ///< the largest volume that one of its surfaces bounds
  std::uint32_t first_triangle = 0;
};

/// The sizes of all solids.  O(N).  @param solid with mesh, shells and triangle_shell; the surfaces may face
/// either way.
std::vector<SolidSize> solid_sizes(const Solid& solid);

/// Finds the specks: solids that are flat or tiny (at most kMinScaledVolume) beside others that are not, as
/// scans have them.  No sample point lies in them, and heights within them are rounding.  Solids far away
/// from the largest one are compared with it beside its own box; see specks.cc.
/// @param solid as for solid_sizes.
/// @param volumes of its solids, scaled coordinates.
/// @return per solid 1 for a speck.
std::vector<std::uint8_t> find_specks(const Solid& solid, const std::vector<double>& volumes);

}  // namespace affskel::core
