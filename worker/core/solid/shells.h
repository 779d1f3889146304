#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/mesh/mesh_topology.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// Finds the closed surfaces of a solid's mesh, what they bound, and which of them are cavities of which: sets shells,
/// triangle_shell and, to 0, solid_volume.  Volumes are in scaled coordinates, and of the sense that the triangles have.
/// @param solid its mesh, scaled and oriented.
/// @throws CoreError kCancelled when the context asks to stop.
void find_shells(const HalfEdges& mates, const SolidOptions& options, Solid& solid);

/// Shells that lie on each other: pairs (i, j), i < j, with equal corners of equally many triangles, each shell with the
/// first that it is like.  Corners are compared by sums of their hashes, 64 bits.
std::vector<std::pair<std::uint32_t, std::uint32_t>> copied_shells(const Solid& solid);

}  // namespace affskel::core
