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
  /// Where hardly a turn is as wide as pruning.strong_turn, this share of the widest one takes its place, 0
  /// .. 1: a frame that makes a flat solid as thick as it is wide makes all its turns narrow...
  double strong_share = 0.8;
  double min_strong_turn = 0.1;  ///< ... but no less than this takes its place, 0 .. 1
  /// Pull of the shocks' mean on a vertex, against 1 for all tangent planes together, > 0.
  double regularisation = 0.05;
  ExecutionContext* context = nullptr;  ///< asked whether to stop, between the steps and layers
};

struct ChordSheetVertex {
  Vec3 position;            ///< frame coordinates, in the vertex's lattice cell and in the solid
  double erosion = 0;       ///< E, volume
  double strength = 0;      ///< mean relative strength r of the cell's shocks
  double area = 0;          ///< mean area of the sections of the two chords, mesh units squared
  Vec3 normal_a, normal_b;  ///< unit normals of the two chords, frame coordinates: a rises to the sheet from
                            ///< the side that normal_a - normal_b points away from
};

/// The shock surface of the E field.
struct ChordSheet {
  std::vector<ChordShock> shocks;          ///< the skeleton's points, by (point, axis)
  std::vector<double> pieces;              ///< see SignificantShocks
  std::uint32_t bridges = 0;               ///< likewise
  double strong_turn = 0;                  ///< that was applied, see ChordSheetOptions::strong_share
  ShockCensus census;                      ///< likewise
  std::vector<ChordSheetVertex> vertices;  ///< in lattice order of their cells (see ChordCells)
  std::vector<Triangle> triangles;         ///< two per shock, in the order of the shocks
};

/// The significant shocks (their turns measured, see measure_turns; pinholes closed, see pinhole_shocks)
/// joined into a sheet by dual contouring (Ju, Losasso, Schaefer and Warren 2002): every lattice cell that
/// has shocks on its edges has one vertex, every shock a quadrilateral through the vertices of the four cells
/// round its edge, cut along its shorter diagonal.  All four always exist, cells partly outside the solid
/// included, so that the sheet has holes only where shocks are missing, and ends where they end: at most half
/// a spacing beyond the outermost.
///
/// A vertex is placed by least squares on the tangent planes of its cell's shocks (normal g_x - g_y), drawn
/// towards their mean, and kept in the cell.  On the rim the mean alone would lie on the outermost shocks
/// and a strip one shock wide would have no area; there the vertex is drawn half the way to the middle of
/// its cell, in the sheet's plane, unless a corner of the cell lies outside the solid.  What then lies
/// outside the solid, because this is concave there or thin, is drawn back to the mean of the cell's shocks,
/// or, when that is outside, too, to the nearest of them: shocks always lie inside.
///
/// The sheet branches where three chords are equal (edges with three and more triangles) and may be
/// one-sided: triangles have no common orientation.  Shocks and vertices lie inside the solid, triangles need
/// not.  The parts of a solid (see SolidParts) have a sheet each, the one that they would have alone, however
/// near they are.  Bytes depend on solid and field alone.
/// @param lattice of this solid.
/// @param field of this lattice.
/// @throws CoreError kBadInput when an option is not finite or out of range; kLimit for 2^30 shocks and more.
ChordSheet chord_sheet(const Solid& solid, const Lattice& lattice, const FrameField& field,
                       const ChordSheetOptions& options = {});

}  // namespace affskel::core
