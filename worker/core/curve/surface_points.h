#pragma once

#include <cstdint>
#include <vector>

#include "core/base/execution_context.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// For each triangle of the solid the sample point next to it: the nearest, in steps of the lattice, to the place
/// half a spacing inward from its centroid.  At a gap between two limbs that is a point of its own limb, where the
/// lattice has one.
/// @return ranks; kNone of DualComplex where no sample point is within four steps.
/// @throws CoreError kCancelled when the context asks to stop.
std::vector<std::uint32_t> surface_points(const Solid& solid, const Lattice& lattice,
                                          ExecutionContext* context = nullptr);

}  // namespace affskel::core
