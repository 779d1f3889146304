#pragma once

#include <cstdint>
#include <vector>

#include "core/chords/chord_shocks.h"
#include "core/lattice/lattice.h"
#include "core/lattice/solid_parts.h"

namespace affskel::core {

// Notation.  The sheet's normal at a shock is N = (g_x - g_y) / |g_x - g_y|; a lattice edge along axis a that
// crosses the sheet stands for |N_a| squares of the lattice, because these add up to the sheet's area.  The
// weight of a shock is  |N_a| r w,  r its relative strength, w its turn (see measure_turns): area weighted by
// strength.
//
// Two shocks touch when their edges bound a common cell.  Passing through a shock costs 1 / (r w): 1 where
// the two normals are opposite, 4 where they differ by 60 degrees, 100 and more between the facets that a
// finite direction set cuts into the level surfaces of E.

struct ChordPruningOptions {
  /// Pieces of the sheet with less than this share of the whole weight in their part of the solid are
  /// dropped, 0 <= significance <= 1; 0 (and any tiny number, 1e-9 say, where 0 stands for the default) keeps
  /// all strong shocks, 1 the only piece if there is but one.  Trunk, legs and arms of a body weigh a tenth
  /// and more each, heads and feet that stand alone a few hundredths, specks a hundredth and less.  Measured
  /// at a body's height / 190 as spacing on 11 bodies of 292 to 8560 triangles: the default leaves one
  /// component on all of them in the `axis` frame, on nine of them in the `affine` frame, which makes a
  /// standing body as thick as high, and 0.02 one on all of them in both.
  double significance = 0.005;
  /// Least turn of a strong shock; 1/2 is a right angle between the normals on the two sides of the band that
  /// measure_turns() looks at.  Right angles are frequent, in boxes all are: the default, 89 degrees, takes
  /// them in whatever rounding does to them.
  double strong_turn = 0.49;
  /// Least E of a strong shock, as a share of the volume of the sample points' cells in its part of the
  /// solid. Where a thousandth of the solid is cut off, the tips of fingers and toes, one shock in three is
  /// lost under vertex noise that nine of ten others survive.
  double min_erosion = 0.001;
  /// Pieces that weaker shocks join at no greater cost than this are weighed as one: noise cuts limbs into
  /// small pieces near each other, and specks lie alone.
  double near_cost = 40;
};

/// What there was to choose from: why nothing may be left.
struct ShockCensus {
  std::uint64_t candidates = 0;
  std::uint64_t wide = 0;     ///< of these, with the turn of a strong shock
  std::uint64_t strong = 0;   ///< of these, with the E of one
  double widest_turn = 0;     ///< of the candidates
  double heaviest_piece = 0;  ///< its share of the weight in its part of the solid, kept or not
};

/// What is left of the candidates.
struct SignificantShocks {
  std::vector<ChordShock> shocks;  ///< in the order of the candidates
  std::vector<double> pieces;      ///< the kept pieces' shares of the weight in their part, largest first
  std::uint32_t bridges = 0;       ///< ways laid between these pieces
  ShockCensus census;
};

/// Removes specks by significance, with hysteresis:
/// 1. strong shocks that touch form pieces; pieces near each other (near_cost) are weighed as one;
/// 2. pieces below the significance are dropped;
/// 3. what is left is joined by the cheapest ways through weaker shocks, as far as there are any (shortest
///    paths from all pieces at once, then a least spanning tree: Mehlhorn 1988);
/// 4. holes are filled: a weaker shock is kept when all four cells round its edge hold kept ones and three or
///    four of the squares lie on the sheet's rim (see chord_squares.h), until there is none left.  Without
///    the squares, a sheet that steps from one layer of cells to the next fills up with the facets in
///    between.
/// Everything here is a function of r, E, w and N alone, and so affinely invariant when these are (see
/// chord_shocks.h).  The parts of a solid have nothing to do with each other: each keeps what it would keep
/// alone, however small it is beside the others.
/// @param parts of the solid in this lattice.
/// @param candidates of this lattice, strong and weak, in the order chord_shocks() gives them, their turns
/// measured.
/// @throws CoreError kBadInput when an option is not finite or out of range; kLimit for 2^30 candidates and
///   more.
SignificantShocks significant_shocks(const Lattice& lattice, const SolidParts& parts,
                                     const std::vector<ChordShock>& candidates,
                                     const ChordPruningOptions& options = {});

}  // namespace affskel::core
