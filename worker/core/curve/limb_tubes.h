#pragma once

#include <cstdint>
#include <functional>

#include "core/base/vec3.h"
#include "core/curve/tubed_limbs.h"

namespace affskel::core {

/// The vertex that a place belongs to, by the vertex of the lines that it is nearest to.
using VertexOfPlace = std::function<std::uint32_t(const Vec3& at, std::uint32_t nearest)>;

/// Parts a solid where its limbs meet, by their tubes (see tubed_limbs()). What lies there in the tube of a limb that
/// is thicker, all in all, belongs to that, of several about as thick to the one that it lies deepest in; what lies
/// in its own tube to that; else it belongs to the limb whose tube it lies deepest in, or is nearest to. So an arm
/// begins where it leaves the trunk, from the armpit to the top of the shoulder, equal limbs share their joint
/// evenly, and a joint itself has nothing, unless it is a hub (see limb_hubs()): then it is the thickest, and its
/// tube is an ellipsoid. A link or loop whose line lies in the tubes of the others that it meets, whole, has nothing
/// either.
/// @return refers to the input's places.
VertexOfPlace limb_tubes(const TubedLimbsInput& input);

}  // namespace affskel::core
