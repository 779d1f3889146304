#pragma once

#include "core/base/vec3.h"

namespace affskel::core {

/// Implicit function of a standing human 1800 mm tall, facing -y, z up, soles at z = 0, mirror-symmetric
/// in x: < 0 inside, > 0 outside, Lipschitz constant 1.  A smooth union of tapered, flattened limbs.
/// @param p in mm.
double body_function(const Vec3& p);

/// A box that holds the body with a margin of 60 mm.
inline constexpr Vec3 kBodyLow{-800, -360, -60};
inline constexpr Vec3 kBodyHigh{800, 360, 1860};

/// Height of the body that body_function describes, mm.
inline constexpr double kBodyHeight = 1800;

}  // namespace affskel::core
