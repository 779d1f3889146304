#pragma once

#include "core/mesh/mesh_topology.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// Finds the closed surfaces of a solid's mesh, what they bound, and which of them are cavities of which: sets shells,
/// triangle_shell and, to 0, solid_volume.  Volumes are in scaled coordinates, and of the sense that the triangles have.
/// @param solid its mesh, scaled and oriented.
/// @throws CoreError kCancelled when the context asks to stop.
void find_shells(const HalfEdges& mates, const SolidOptions& options, Solid& solid);

}  // namespace affskel::core
