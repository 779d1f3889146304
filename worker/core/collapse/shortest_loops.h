#pragma once

#include <cstddef>
#include <vector>

#include "core/base/execution_context.h"
#include "core/collapse/cell_sets.h"
#include "core/collapse/dual_complex.h"

namespace affskel::core {

/// A closed way along edges of a complex.
struct CellLoop {
  std::vector<DualComplex::Cell> vertices, edges;  ///< once round: each edge leads on from its vertex
};

/// The shortest loops of what a collapse has left: of its lone edges, those of no square; what squares join
/// counts as one place.  Each is the shortest loop of what is left of the graph when an edge of every one before
/// is taken out, so that none is a sum of others (a cycle basis, nearly the least one).
/// @param left closed under taking boundaries, without cubes.
/// @param count at most so many.
/// @throws CoreError kCancelled when the context asks to stop.
std::vector<CellLoop> shortest_loops(const DualComplex& complex, const CellSet& left, std::size_t count,
                                     ExecutionContext* context = nullptr);

}  // namespace affskel::core
