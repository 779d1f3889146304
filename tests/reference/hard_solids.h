#pragma once

#include <cstdint>

#include "core/mesh/mesh.h"

namespace affskel::reference {

/// Solids that are hard on connected components, for the tests against the oracles.

/// A tube of radius `tube` wound `turns` times round the z axis at distance `radius`, rising by `pitch` per
/// turn, `segments` pieces per turn and `sides` round the tube, closed by flat ends: for directions across
/// the axis a minimum per turn.  The turns must not touch: pitch > 2 tube.
core::Mesh make_helix(double radius, double tube, double pitch, std::uint32_t turns, std::uint32_t segments,
                      std::uint32_t sides);

/// Two tori that hold each other like links of a chain.
core::Mesh linked_tori(std::uint32_t triangles_each);

/// A ball in the cavity of a shell in the cavity of a shell: three solids, none touching.
core::Mesh nested_shells();

}  // namespace affskel::reference
