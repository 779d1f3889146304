#pragma once

#include <functional>
#include <span>

#include "core/base/execution_context.h"
#include "core/base/vec3.h"
#include "core/contour/sheet_mesh.h"
#include "core/lattice/lattice.h"
#include "core/lattice/lattice_edges.h"
#include "core/lattice/solid_parts.h"

namespace affskel::core {

/// Where a sheet crosses a lattice edge.
struct SheetCrossing {
  LatticeEdge edge;
  Vec3 position;  ///< frame coordinates, on the edge and in the solid
  Vec3 normal;    ///< of the sheet, unit, of either sign
};

/// What a vertex of the sheet tells of its cell's crossings.
/// @param position of the vertex; the function's value need not have it.
/// @param crossings of the cell, indices, ascending.
using VertexOfCell =
    std::function<SheetVertex(const Vec3& position, std::span<const std::uint32_t> crossings)>;

/// The sheet through the crossings by dual contouring (Ju, Losasso, Schaefer and Warren 2002): one vertex for
/// every lattice cell with crossings on its edges, one quadrilateral for every crossing, through the vertices
/// of the four cells round its edge, cut along its shorter diagonal.  Which edges are crossed is the
/// caller's: sheets may have rims, branches and one side only.
///
/// Vertices lie in the solid and in their cells; triangles need not.  The sheet ends at most half a spacing
/// beyond its outermost crossings.
/// @param parts of the solid in this lattice.
/// @param crossings each edge once.
/// @param vertex_of values of the vertices.
/// @param context asked at every layer whether to stop.
/// @return vertices in lattice order of their cells (see EdgeCells); two triangles per crossing, in the order
///   of the crossings.
/// @throws CoreError kLimit for 2^30 crossings and more; kCancelled when the context asks to stop.
SheetMesh dual_contour(const Lattice& lattice, const SolidParts& parts,
                       std::span<const SheetCrossing> crossings, const VertexOfCell& vertex_of,
                       ExecutionContext* context);

}  // namespace affskel::core
