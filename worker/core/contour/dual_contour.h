#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>

#include "core/base/execution_context.h"
#include "core/base/vec3.h"
#include "core/contour/edge_cells.h"
#include "core/contour/sheet_mesh.h"
#include "core/lattice/lattice.h"
#include "core/lattice/solid_parts.h"

namespace affskel::core {

/// Where a sheet crosses a lattice edge.
struct SheetCrossing {
  Vec3 position;  ///< frame coordinates, on its edge and in the solid
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
/// @param cells of the crossings' edges, see edge_cells().
/// @param crossings each edge once.
/// @param vertex_of values of the vertices.
/// @param context asked whether to stop; may be null.
/// @return vertices in the order of their cells; two triangles per crossing, in the order of the crossings,
///   which agree on their senses (see agree_on_senses()).
/// @throws CoreError kCancelled when the context asks to stop.
SheetMesh dual_contour(const Lattice& lattice, const SolidParts& parts, const EdgeCells& cells,
                       std::span<const SheetCrossing> crossings, const VertexOfCell& vertex_of,
                       ExecutionContext* context);

/// Two triangles for a quadrilateral of the sheet, cut along its shorter diagonal.
void add_quad(const std::array<std::uint32_t, 4>& ring, SheetMesh& sheet);

}  // namespace affskel::core
