#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/contour/sheet_mesh.h"
#include "core/mesh/edges.h"

namespace affskel::core {

/// Draws the rims of a ridge surface back to the line where its strength is `low`: a weaker vertex on a rim goes to the mean of
/// the places of that line, by linear interpolation of 1 / strength, on the ways to its strong neighbours in the same square;
/// one that has none beside it, as at a corner, to that on the way across the square.
/// @param vertices of a skeleton. @param rings corners of its squares, once round. @param rim_neighbours per vertex, along rims.
/// @return the vertices.
std::vector<SheetVertex> drawn_rims(const std::vector<SheetVertex>& vertices,
                                    const std::vector<std::array<std::uint32_t, 4>>& rings,
                                    const Adjacency& rim_neighbours, double low);

/// How often vertices on rims are to be drawn half-way to the mean of their two neighbours there, to even the rims out:
/// `most` times, on one of n vertices n^2 / 32 at most.  A ring of them then keeps about three quarters of its size; it would
/// become a point.
/// @return per vertex.
std::vector<int> rim_passes(const Adjacency& rim_neighbours, int most);

}  // namespace affskel::core
