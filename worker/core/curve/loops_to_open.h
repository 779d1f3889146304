#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Which segments of a graph in a solid to take out, so that no loop is left that bounds in the solid, alone or with
/// others: those that stay are the ones of the greatest values (the greedy basis of the matroid of segments, of which
/// loops that bound are the circuits; in a solid without tunnels a greatest spanning forest, Kruskal 1956).  Pieces stay
/// as they are, and so does what winds round the solid's tunnels, modulo 2.
/// @param value per segment.
/// @param windings per loop of the solid's boundary the share of a way along a segment, from its first vertex to its
///   second, in their linking number; see SolidWindings.  Asked only where `loops` is not 0.
/// @return numbers of segments, ascending.  A function of its arguments alone.
std::vector<std::uint32_t> loops_to_open(std::size_t vertices, std::span<const Segment> segments,
                                         std::span<const double> value, std::size_t loops,
                                         const std::function<std::vector<double>(std::uint32_t)>& windings);

}  // namespace affskel::core
