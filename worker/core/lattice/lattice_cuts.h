#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/execution_context.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// What the surface does to the edge between a lattice place and its neighbour.  Shares of the edge's length
/// are counted from its lower end.
struct LatticeCut {
  std::uint64_t edge = 0;  ///< see LatticeCuts::edge
  double leaves = 1;       ///< where the edge first leaves the solid, coming from the lower end; 1 = nowhere
  double enters = 0;       ///< where it last enters the solid towards the upper end; 0 = nowhere
  bool gap = false;        ///< it leaves the solid and enters it again
};

/// The crossings of the surface with the edges of the Freudenthal (Kuhn) split of a lattice: those from place
/// (i, j, k) to (i + a, j + b, k + c), where a, b, c are 0 or 1 and `step` = 4a + 2b + c, 1 to 7.  Places go
/// from -1 to dims: one layer more on every side.
///
/// Along the axes these are the crossings that made the lattice's runs.  Along the diagonals a line may
/// disagree with the lattice about what is inside, within rounding of the surface: an edge can then have one
/// end inside and no cut.
///
/// Memory in the order of the mesh's vertices and of the crossings, whatever the lattice; time likewise, and
/// in the order of the triangles' lengths in steps.
class LatticeCuts {
 public:
  /// @throws CoreError kCancelled when the context, if there is one, asks to stop.
  LatticeCuts(const Solid& solid, const Lattice& lattice, ExecutionContext* context = nullptr);

  /// Number of the edge from a place by a step.
  std::uint64_t edge(std::int64_t i, std::int64_t j, std::int64_t k, unsigned step) const {
    const std::int64_t place = ((i + 1) * size_[1] + (j + 1)) * size_[2] + (k + 1);
    return static_cast<std::uint64_t>(place) * 8 + step;
  }

  /// The cut of an edge; nullptr when the surface does not meet it.
  const LatticeCut* find(std::uint64_t edge) const;

  /// All cut edges, ascending.
  const std::vector<LatticeCut>& all() const { return cuts_; }

 private:
  void add_step(const Solid& solid, const Lattice& lattice, unsigned step, ExecutionContext* context);

  std::array<std::int64_t, 3> size_{};  // dims + 2
  std::vector<LatticeCut> cuts_;
};

}  // namespace affskel::core
