#pragma once

#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/vec3.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// An end of the solid that the lattice is too coarse for, so that no skeleton leads there.
struct UnreachedEnd {
  Vec3 place;           ///< the corner of its surface farthest from the skeleton, mesh units
  double distance = 0;  ///< from there to the skeleton's nearest vertex, mesh units
};

/// The ends of a solid that its skeleton does not reach: connected pieces of the surface whose corners lie
/// farther than two spacings, in the lattice's frame, from every sample point that has a skeleton.  All other
/// ends are in the complex that was collapsed, and have one by construction.
/// @param left_out per sample point: not 0 where there is no skeleton, see RidgeAnchors.
/// @param skeleton places of its vertices, mesh units.
/// @return the farthest first.
/// @throws CoreError kCancelled when the context asks to stop.
std::vector<UnreachedEnd> unreached_ends(const Solid& solid, const Lattice& lattice,
                                         std::span<const char> left_out, std::span<const Vec3> skeleton,
                                         ExecutionContext* context = nullptr);

}  // namespace affskel::core
