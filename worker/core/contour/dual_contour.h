#pragma once

#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/vec3.h"
#include "core/contour/edge_cells.h"
#include "core/lattice/lattice.h"
#include "core/lattice/lattice_edges.h"
#include "core/lattice/solid_parts.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Where a sheet crosses a lattice edge.
struct SheetCrossing {
  LatticeEdge edge;
  Vec3 position;  ///< frame coordinates, on the edge and in the solid
  Vec3 normal;    ///< of the sheet, unit, of either sign
};

struct DualContourOptions {
  /// Pull of the crossings' mean on a vertex, against 1 for all tangent planes together, > 0.
  double regularisation = 0.05;
  ExecutionContext* context = nullptr;  ///< asked at every layer whether to stop
};

/// A sheet without orientation.
struct DualContour {
  EdgeCells cells;                  ///< round the crossed edges
  std::vector<Vec3> vertices;       ///< per cell, frame coordinates
  std::vector<Triangle> triangles;  ///< two per crossing, in the order of the crossings
};

/// The sheet through the crossings by dual contouring (Ju, Losasso, Schaefer and Warren 2002): one vertex for
/// every lattice cell with crossings on its edges, one quadrilateral for every crossing, through the vertices
/// of the four cells round its edge, cut along its shorter diagonal.  Which edges are crossed is the
/// caller's: sheets may have rims, branches and one side only.
///
/// Vertices lie in the solid and in their cells; triangles need not.  The sheet ends at most half a spacing
/// beyond its outermost crossings.
/// @param parts of the solid in this lattice.
/// @param crossings each edge once.
/// @throws CoreError kBadInput when the regularisation is not a finite number > 0; kLimit for 2^30 crossings
///   and more; kCancelled when the context asks to stop.
DualContour dual_contour(const Lattice& lattice, const SolidParts& parts,
                         std::span<const SheetCrossing> crossings, const DualContourOptions& options = {});

}  // namespace affskel::core
