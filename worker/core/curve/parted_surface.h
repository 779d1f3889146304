#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/none.h"
#include "core/lattice/lattice.h"
#include "core/mesh/mesh.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// The surface of a solid, its triangles cut where its parts meet.
struct PartedSurface {
  Mesh mesh;  ///< scaled coordinates; closed as the solid's is, whose vertices come first
  std::vector<std::uint32_t> point;  ///< per triangle, the sample point next to it; or kNone
};

/// The sample point next to a place of the surface is the nearest, in steps of the lattice, to the place half a spacing
/// inward: at a gap between two limbs a point of its own limb, where the lattice has one.  There is none where no
/// sample point is within four steps.  A triangle next to points of several parts is halved across its longest edge,
/// until each of its pieces has one part or no edge longer than the spacing; its neighbours are cut where it is.
/// Mixed triangles as in Rivara 1984: their angles stay at least half of what they were.
/// @param part per sample point.
/// @throws CoreError kCancelled when the context asks to stop.
PartedSurface parted_surface(const Solid& solid, const Lattice& lattice, std::span<const std::uint32_t> part,
                             ExecutionContext* context = nullptr);

}  // namespace affskel::core
