#pragma once

#include <cstdint>
#include <vector>

#include "core/chords/chord_shocks.h"
#include "core/lattice/lattice.h"
#include "core/lattice/solid_parts.h"

namespace affskel::core {

// Notation.  N = (g_x - g_y) / |g_x - g_y| is the sheet's normal at a shock, whose lattice edge, along axis
// a, stands for |N_a| squares of the lattice.  The weight of a shock is |N_a| r w, with r its relative
// strength and w its turn (see measure_turns).  Two shocks touch when their edges bound a common cell.  A
// path through a shock costs 1 / (r w).

/// Counts of the candidates, to tell why nothing may be left.
struct ShockCensus {
  std::uint64_t candidates = 0;
  std::uint64_t wide = 0;      ///< candidates with the turn of a strong shock
  std::uint64_t strong = 0;    ///< candidates with its turn and E
  double max_turn = 0;         ///< of the candidates
  double max_piece_share = 0;  ///< largest share of the weight in a part of the solid, kept or not
};

/// What is left of the candidates.
struct SignificantShocks {
  std::vector<ChordShock> shocks;  ///< in the order of the candidates
  std::vector<double> pieces;      ///< the kept pieces' shares of the weight in their part, largest first
  std::uint32_t bridges = 0;       ///< paths that join these pieces
  ShockCensus census;
};

/// Keeps the shocks that matter, by hysteresis:
/// 1. strong shocks that touch form pieces; pieces near each other (near_cost) are weighed as one;
/// 2. pieces below the significance are dropped;
/// 3. the others are joined by the cheapest paths through weaker shocks, as far as there are any.
/// Holes are left to pinhole_shocks().
/// A function of r, E, w and N alone, affinely invariant when these are.  Each part of the solid keeps what
/// it would keep alone.  O(n log n) for n candidates.
/// @param parts of the solid in this lattice.
/// @param candidates of this lattice, strong and weak, by (point, axis), their turns measured.
/// @param significance pieces of the sheet with less than this share of the weight in their part of the solid
///   are dropped, 0 .. 1.  0 keeps all strong shocks (where 0 stands for the default, take 1e-9), 1 only a
///   piece that is alone.
/// @throws CoreError kBadInput when the significance is out of range; kLimit for 2^30 candidates and more.
SignificantShocks significant_shocks(const Lattice& lattice, const SolidParts& parts,
                                     const std::vector<ChordShock>& candidates, double significance,
                                     const ChordConstants& constants = {});

}  // namespace affskel::core
