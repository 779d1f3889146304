#pragma once

#include <cstdint>
#include <vector>

#include "core/base/execution_context.h"
#include "core/contour/sheet_mesh.h"
#include "core/lattice/lattice.h"
#include "core/ridge/ridge_values.h"

namespace affskel::core {

/// A ridge curve as a polyline, one vertex for each lattice cell on its way.
struct RidgeCurve {
  std::vector<SheetVertex> vertices;  ///< two or more, three when closed; strength is s_2, see ridge_curves()
  /// Per vertex: the sample point at its cell's lowest corner.  Cells in a row share a lattice face.
  std::vector<std::uint32_t> cells;
  bool closed = false;  ///< the last vertex is followed by the first
};

/// The ridge curves of E (height ridges of codimension 2: Eberly 1996, chapter 3): grad P is orthogonal to
/// e_1 and e_2, the eigenvectors of the two least eigenvalues lambda_1 <= lambda_2 < 0 of P's Hessian, and so
/// parallel to e_3 (parallel vectors: Peikert and Roth 1999).  The axis of a round limb is one.
///
/// Every lattice cell is cut into six tetrahedra about one diagonal (Kuhn 1960).  With v the part of grad P
/// orthogonal to e_3, the zero of v in a triangle follows from the signs of the determinants |e v v'| of its
/// edges alone.  These are the same for all triangles about an edge, so that a tetrahedron has two crossed
/// triangles or none, and joins them: curves never meet or branch, and end only where a bound ends them or
/// where e_3 turns by more than a right angle within a cell.
///
/// The strength s_2 = -lambda_2 E / |grad E|^2 is the angle by which the normals of the level surfaces turn
/// over one depth, in the weaker of the two directions.
/// @param values of the lattice; their bounds hold for s_2 and E.
/// @return one vertex for each cell that a curve passes through, the mean of its points there; in lattice
///   order of the curves' ends, then the closed ones.
/// @throws CoreError kCancelled when the context asks to stop.
std::vector<RidgeCurve> ridge_curves(const Lattice& lattice, const RidgeValues& values,
                                     ExecutionContext* context = nullptr);

}  // namespace affskel::core
