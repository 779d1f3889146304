#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/collapse/cell_sets.h"
#include "core/collapse/dual_complex.h"
#include "core/collapse/shortest_ways.h"

namespace affskel::core {

struct CollapseOptions {
  /// Per cube: what a way through it costs for each spacing of its length, > 0; empty: 1 everywhere.
  std::vector<float> cost;
  ExecutionContext* context = nullptr;  ///< asked whether to stop
};

/// What is left of the complex.
struct Collapsed {
  CellSet cells;
  std::uint32_t opened = 0;  ///< anchors that were given up, each to open a pocket
};

/// Collapses a complex onto anchors: removes free pairs (see Collapsing) that are no anchors as long as there
/// are any, those farthest from the anchors first.  What is left has the pieces, tunnels and voids of the
/// complex (elementary collapses keep the homotopy type: Whitehead 1939) and no cube: it is the anchors,
/// joined by lines on cheapest ways, with membranes across their holes.  A pocket, cubes that anchors enclose
/// all round, is opened at its lightest square.
///
/// Components without an anchor collapse to a vertex, or to circles and closed surfaces where they have
/// tunnels and voids.  A function of complex, anchors and costs alone.
/// @param anchors each cell once.
/// @throws CoreError kCancelled when the context asks to stop.
Collapsed collapse(const DualComplex& complex, std::span<const Anchor> anchors, CollapseOptions options = {});

/// Collapses what is left of a complex as far as it goes, in any order.
/// @param cells closed under taking boundaries.
/// @param anchors of these, those that are among the cells.
/// @throws CoreError kCancelled when the context asks to stop.
CellSet collapsed(const DualComplex& complex, const CellSet& cells, std::span<const Anchor> anchors,
                  ExecutionContext* context = nullptr);

/// The Betti numbers' first: how many components cells form that are closed under taking boundaries.
std::uint64_t count_components(const DualComplex& complex, const CellSet& cells);

}  // namespace affskel::core
