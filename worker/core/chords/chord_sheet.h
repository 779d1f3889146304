#pragma once

#include <cstdint>
#include <vector>

#include "core/base/execution_context.h"
#include "core/chords/chord_pruning.h"
#include "core/chords/chord_shocks.h"
#include "core/chords/chord_turns.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/mesh/mesh.h"
#include "core/solid/solid.h"

namespace affskel::core {

struct ChordSheetOptions {
  ChordShockOptions shocks;     ///< the candidates
  ChordTurnOptions turns;       ///< how far the normals turn at them
  ChordPruningOptions pruning;  ///< which of them stay; its `significance` is the threshold of `chords`
  /// Where no turn is that wide, a strong one has this share of the largest turn instead of
  /// pruning.strong_turn, 0 .. 1, but at least min_strong_turn.
  double strong_share = 0.8;
  double min_strong_turn = 0.1;  ///< 0 .. 1
  /// Pull of the shocks' mean on a vertex, against 1 for all tangent planes together, > 0.
  double regularisation = 0.05;
  ExecutionContext* context = nullptr;  ///< asked whether to stop, between the steps and layers
};

struct ChordSheetVertex {
  Vec3 position;            ///< frame coordinates, in the vertex's lattice cell and in the solid
  double erosion = 0;       ///< E, volume
  double strength = 0;      ///< mean relative strength r of the cell's shocks
  double area = 0;          ///< mean area of the sections of the two chords, mesh units squared
  Vec3 normal_a, normal_b;  ///< unit normals of the two chords, frame coordinates; normal_a - normal_b
                            ///< points from a's side of the sheet to b's
};

/// The shock surface of the E field.
struct ChordSheet {
  std::vector<ChordShock> shocks;          ///< the skeleton's points, by (point, axis)
  std::vector<double> pieces;              ///< see SignificantShocks
  std::uint32_t bridges = 0;               ///< see SignificantShocks
  double strong_turn = 0;                  ///< the one applied, see ChordSheetOptions::strong_share
  ShockCensus census;                      ///< see SignificantShocks
  std::vector<ChordSheetVertex> vertices;  ///< in lattice order of their cells (see EdgeCells)
  std::vector<Triangle> triangles;         ///< two per shock, in the order of the shocks
};

/// The significant shocks joined into a sheet by dual contouring (Ju, Losasso, Schaefer and Warren 2002): one
/// vertex for every lattice cell with shocks on its edges, one quadrilateral for every shock, through the
/// vertices of the four cells round its edge, cut along its shorter diagonal.  README.md in worker/core tells
/// how and why.
///
/// Vertices and shocks lie in the solid, vertices in their cells too; triangles need not.  The sheet ends at
/// most half a spacing beyond its outermost shocks, branches where three chords are equal (edges with three
/// and more triangles) and may be one-sided: triangles have no common orientation.  Each part of the solid
/// (see SolidParts) has the sheet that it would have alone.  A function of solid, lattice and field alone.
/// @param lattice of this solid.
/// @param field of this lattice.
/// @throws CoreError kBadInput when an option is not finite or out of range; kLimit for 2^30 shocks and more;
///   kCancelled when the context asks to stop.
ChordSheet chord_sheet(const Solid& solid, const Lattice& lattice, const FrameField& field,
                       const ChordSheetOptions& options = {});

}  // namespace affskel::core
