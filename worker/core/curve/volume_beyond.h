#pragma once

#include <span>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// What a cut at a vertex of a graph parts from the heaviest rest of its piece: the weight of all other pieces
/// that are left without the vertex, and half of its own.  At an end half of its own, along a limb what lies
/// beyond, on a loop half of its own.  By biconnected components (Hopcroft and Tarjan 1973), O(vertices + segments).
/// @param segments each once, of two different vertices.
/// @param weight per vertex, >= 0.
/// @return per vertex.
std::vector<double> volume_beyond(std::span<const Segment> segments, std::span<const double> weight);

}  // namespace affskel::core
