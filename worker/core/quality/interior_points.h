#pragma once

#include <cstdint>
#include <vector>

#include "core/base/vec3.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// So many points spread evenly over the inside of a solid, mesh units, however thin it is: on lines along its
/// longest principal axis, as many per length on every line.  Neither random nor periodic; only + - * / and
/// sqrt.  At most 8 `count` lines are cut with the surface.
/// The share_within(r) of their DistanceCurve (similarity.h) from a skeleton is the chance level at r (see
/// chance_level.h).
/// @param count > 0.
/// @throws CoreError kBadInput when the solid is so thin that none of the lines meets its inside.
std::vector<Vec3> interior_points(const Solid& solid, std::uint32_t count = 50000);

}  // namespace affskel::core
