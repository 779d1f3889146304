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

  double longest_side() const;
};

/// The sizes of all solids.  O(N).  @param solid with mesh, shells and triangle_shell; the surfaces may face
/// either way.
std::vector<SolidSize> solid_sizes(const Solid& solid);

/// Specks: solids with no more than kMinScaledVolume, flat or tiny, beside others that have more, as scans
/// have them.  No sample point comes to lie in them, and heights within them are rounding.
///
/// A speck may lie so far away that, beside the mesh's whole box, no solid has more.  Then the others are
/// compared with the largest solid, provided that it has more beside its own box.
///
/// A solid is no speck when its volume, or that of one of its surfaces (a skin thinner than rounding has
/// such), is more than kSpeckShare of the largest solid's; nor when it has a surface of more than the least
/// volume; nor when its volume counts beside the box of it and those it is compared with, as when the mesh is
/// large only because its specks lie far away, and there are such specks.
/// @param solid as for solid_sizes.  @param volumes of its solids, scaled coordinates.
/// @return per solid 1 for a speck.
std::vector<std::uint8_t> find_specks(const Solid& solid, const std::vector<double>& volumes);

}  // namespace affskel::core
