#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/edges.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Two half-edges of an edge whose triangles are neighbours.
using MatedSides = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Parts of a solid may touch along an edge, so that more than two triangles meet there.  Each is paired with the next
/// one across the solid, in the order of their angles about the edge: the parts are apart then, as those are that touch
/// in a vertex.
/// @param sides of one edge. @param inside_out the triangles face the solid.
/// @return empty unless as many triangles pass the edge one way as the other, and all have an area.
MatedSides mate_across_solid(const Mesh& mesh, std::span<const EdgeSide> sides, bool inside_out);

/// Gives parts of a solid that touch along edges vertices of their own there, where mate_across_solid can tell the
/// parts; where they share both ends all the same, one within the edge.  Other edges, open ones among them, stay as they
/// are.
/// @return how many vertices were added (at the end).
std::uint32_t separate_touching_edges(Mesh& mesh);

}  // namespace affskel::core
