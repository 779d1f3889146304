#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/lattice/lattice.h"
#include "core/ridge/row_band.h"

namespace affskel::core {

/// Values on a band of places round a solid.
struct ContinuedField {
  RowBand band;
  std::vector<float> values;  ///< per place of the band
};

/// Continues values from the sample points of a solid: at a place outside, the mean over the nearest sample
/// points p of  value_p + gradient_p . (place - p), clamped to 0 .. value_p.  "Nearest" is found step by step
/// from neighbouring places (26), as in a vector distance transform (Danielsson 1980).
/// @param value of a sample point.
/// @param gradient of a sample point, per spacing; asked for next to the surface alone.
/// @param reach per sample point: which places are asked for, those no more steps away along each axis.
/// @param threads >= 1; the result does not depend on it.
/// @return the band is the hull, row by row, of the places asked for.
ContinuedField continued_field(const Lattice& lattice, const std::function<double(std::uint32_t)>& value,
                               const std::function<Vec3(std::uint32_t)>& gradient,
                               std::span<const std::uint8_t> reach, unsigned threads = 1);

}  // namespace affskel::core
