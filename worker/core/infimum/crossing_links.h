#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/none.h"
#include "core/mesh/mesh.h"
#include "core/mesh/mesh_topology.h"

namespace affskel::core {

/// Two triangles that pass through each other: the parts of a solid below a plane that they belong to are one as soon
/// as both have begun, that is, have corners below it.
struct CrossingPair {
  std::uint32_t first = 0, second = 0;
  /// Vertices of `second`: where one of them lies below a plane, the pair joins nothing that the surface and the other
  /// pairs do not.  The same one twice, or none, where a line of pairs begins.
  std::array<std::uint32_t, 2> links{kNone, kNone};
};

/// Finds the links.  Pairs follow one another along the lines in which surfaces pass through each other: the next one
/// shares a triangle, its `first`, and its `second` is next to the other one's, across the edge of its links.  With an
/// end of that below, and `first` begun, the pair before has begun, too, and `second` has that end.  The first pair of
/// a line has the corner that both triangles share, if there is one.
/// @param mates of the mesh's half-edges 3 t + i.
/// @param pairs of triangles, each once; in any order.
/// @return by the lesser triangle, then the other.
std::vector<CrossingPair> link_crossings(const Mesh& mesh, const HalfEdges& mates,
                                         std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs);

}  // namespace affskel::core
