#pragma once

#include <cstdint>
#include <vector>

#include "core/base/execution_context.h"
#include "core/chords/chord_pruning.h"
#include "core/chords/chord_shocks.h"
#include "core/chords/equal_chords.h"
#include "core/contour/sheet_mesh.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid.h"

namespace affskel::core {

struct ChordSheetOptions {
  double significance = 0.005;  ///< the threshold of `chords`, see significant_shocks()
  const RefinedPieces* refined =
      nullptr;  ///< of a field over all directions; null: it is the least of a finite set
  ExecutionContext* context = nullptr;  ///< asked whether to stop, between the steps and layers
};

/// The shock surface of the E field; has no segments.
struct ChordSheet : SheetMesh, SignificantShocks {
  double strong_turn = 0;  ///< the one applied, see ChordConstants::strong_share
};

/// The significant shocks joined into a sheet by dual contouring (Ju, Losasso, Schaefer and Warren 2002): one
/// vertex for every lattice cell with shocks on its edges, one quadrilateral for every shock, through the
/// vertices of the four cells round its edge, cut along its shorter diagonal.  Over all directions shocks lie
/// where the two chords are equal, as far as there are two (place_at_equal_chords).  README.md in worker/core tells
/// how and why.
///
/// Vertices and shocks lie in the solid, vertices in their cells too; triangles need not.  The sheet ends at
/// most half a spacing beyond its outermost shocks, branches where three chords are equal (edges with three
/// and more triangles) and may be one-sided; else triangles agree on their senses.  Each part of the solid
/// (see SolidParts) has the sheet that it would have alone.  A function of solid, lattice and field alone.
/// @param lattice of this solid.
/// @param field of this lattice.
/// @throws CoreError kBadInput when the significance is out of range; kLimit for 2^30 shocks and more;
///   kCancelled when the context asks to stop.
ChordSheet chord_sheet(const Solid& solid, const Lattice& lattice, const FrameField& field,
                       const ChordSheetOptions& options = {});

}  // namespace affskel::core
