#pragma once

#include <cstdint>
#include <span>

#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// A vertex known only to lie on a line segment: at from + t along, min_share <= t <= max_share.
struct LooseVertex {
  std::uint32_t vertex = 0;
  Vec3 from, along;
  double min_share = 0, max_share = 1;
  double share = 0.5;  ///< t, where the vertex starts
};

/// Moves loose vertices of a closed mesh along their line segments until the surface is as even as these
/// allow (in the spirit of Gibson's constrained elastic surface nets, 1998): in each round every loose vertex
/// goes half way to where its line meets the plane through the mean of its neighbours, normal to the surface
/// there.  The other vertices stay.  A plane is a fixed point.
/// Linear in rounds times the size of the mesh; a function of its arguments alone.
/// @throws CoreError kCancelled when the context, if there is one, asks to stop; it is asked in every round.
void relax_loose_vertices(std::span<LooseVertex> loose, int rounds, Mesh& mesh,
                          ExecutionContext* context = nullptr);

}  // namespace affskel::core
