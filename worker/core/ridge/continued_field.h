#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/lattice/lattice.h"
#include "core/ridge/row_band.h"

namespace affskel::core {

/// Values on a band round a solid, continued from its sample points: at a place outside, the mean over the
/// nearest sample points p of  value_p + gradient_p . (place - p), clamped to 0 .. value_p.  "Nearest" is
/// found step by step from neighbouring places (26), as in a vector distance transform (Danielsson 1980), as
/// far as somebody asks; beyond that and the band's margin the value is 0.
/// @param value per sample point.
/// @param gradient of a sample point, per spacing; asked for near the surface alone.
/// @param reach per sample point: which places are asked for, those no more steps away along each axis.
/// @return per place of the band.
std::vector<float> continued_field(const Lattice& lattice, const RowBand& band, std::span<const double> value,
                                   const std::function<Vec3(std::uint32_t)>& gradient,
                                   std::span<const std::uint8_t> reach);

}  // namespace affskel::core
