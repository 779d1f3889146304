#pragma once

#include <span>

#include "core/mesh/mesh.h"
#include "core/solid/betti_numbers.h"

namespace affskel::core {

/// The Betti numbers of a triangulated sheet, which may have rims, branches and closed surfaces, and its curves (a
/// vertex that neither uses is a piece of its own), from V - E + F = b0 - b1 + b2; b2 counts the voids that it encloses
/// in space. Time O(F log F), and an elimination in the number of patches at branches.
/// @param sheet triangles distinct, each with three distinct corners; orientation does not matter.
/// @param segments of curves, two distinct vertices of the sheet each; they may run along its edges.
BettiNumbers sheet_betti_numbers(const Mesh& sheet, std::span<const Segment> segments = {});

}  // namespace affskel::core
