#pragma once

#include <cstdint>
#include <vector>

#include "core/solid/solid.h"

namespace affskel::core {

/// The least volume of a solid that can be told from rounding, in inner coordinates: a share of the cube
/// whose side is about the mesh's longest.
inline constexpr double kLeastInnerVolume = 1e-15;

/// Specks: solids with no more than that volume, flat or tiny, beside others that have more, as scans have
/// them.  No sample point comes to lie in them, and heights within them are rounding.
///
/// A solid is no speck when it has a surface of more volume, such as a skin thinner than rounding; nor when
/// its volume counts beside the box of it and the solids that have more, as when the mesh is large only
/// because its specks lie far away, and there are such specks.  When no solid has more, none is a speck.
/// @param solid with mesh and shells in inner coordinates.  @param volumes of its solids, in these.
/// @return per solid 1 for a speck.
std::vector<std::uint8_t> find_specks(const Solid& solid, const std::vector<double>& volumes);

}  // namespace affskel::core
