#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/collapse/cell_sets.h"
#include "core/collapse/dual_complex.h"
#include "core/collapse/shortest_ways.h"
#include "core/lattice/lattice.h"
#include "core/solid/betti_numbers.h"

namespace affskel::core {

/// A solid whose surface noise makes cross itself.
struct NoisySolid {
  const Lattice& lattice;
  const DualComplex& complex;
  std::span<const float> radius;     ///< per sample point: distance to the surface, spacings
  std::span<const float> thickness;  ///< per sample point, spacings: see section_radii()
  std::uint64_t handles = 0;         ///< of its surface
};

struct BoredCells {
  /// By the order in which they are opened; no edges where there are more than kMostBored loops: the lattice resolves no
  /// solid at all.
  std::vector<DualComplex::Cell> cells;
  CellSet left;   ///< without them, collapsed onto the anchors
  CellSet graph;  ///< that, collapsed as far as it can be
};

/// Cells that open what noise has bored.  Noise that makes a surface cross itself bores tunnels and voids through limbs, a
/// hundred in a body of 5000 triangles at 1 % of the diagonal; the solid is taken to have those of its surface alone.
/// Where there are membranes about voids, of each the square nearest to the surface.  Else, of the shortest loops, as many
/// as there are more than handles, of each that lies within kBored times the limb's thickness at one of its places the
/// edge nearest to the surface; loops between limbs that pass through each other stay.  Of loops that share places one
/// after the other, as what is left collapses on.
/// @param left what a collapse has left of the complex.
/// @param anchors which stay, with their boundaries.
/// @throws CoreError kCancelled when the context asks to stop.
BoredCells bored_cells(const NoisySolid& solid, const CellSet& left, std::span<const Anchor> anchors = {},
                       ExecutionContext* context = nullptr);

/// Fills what noise has bored: the cells that bored_cells() names are taken out, and what hangs loose then goes as
/// far as the anchors.  Limbs with such loops have tips, see limb_tips().
/// @param before of the complex.
/// @return of the complex filled: of what is left, with as many components as before.
BettiNumbers fill_bored(const NoisySolid& solid, const BettiNumbers& before, std::span<const Anchor> anchors,
                        CellSet& left, ExecutionContext* context = nullptr);

inline constexpr double kBored = 2;
inline constexpr std::size_t kMostBored = 512;

}  // namespace affskel::core
