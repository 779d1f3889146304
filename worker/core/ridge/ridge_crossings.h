#pragma once

#include <deque>

#include "core/base/vec3.h"
#include "core/contour/sheet_mesh.h"
#include "core/lattice/lattice.h"
#include "core/lattice/lattice_edges.h"
#include "core/ridge/ridge_values.h"

namespace affskel::core {

/// A point of the ridge surface of E on a lattice edge.
struct RidgeCrossing {
  LatticeEdge edge;
  Vec3 normal;     ///< of the sheet: e_1, unit, of either sign
  SheetVertex at;  ///< in the solid
};

/// Where the ridge surfaces of E cross lattice edges (height ridges of codimension 1: Haralick 1983; Eberly
/// 1996, chapter 3): grad P is orthogonal to e_1, the eigenvector of the least eigenvalue lambda_1 < 0 of P's
/// Hessian.  e_1 is oriented alike at both ends of an edge; a sign change of e_1 . grad P is placed by linear
/// interpolation.  The same for any increasing function P of E, but for the smoothing.
///
/// The strength s = -lambda E / |grad E|^2, lambda the eigenvalue for E along e_1, is the angle by which the
/// normals of the level surfaces turn over one depth d = E / |grad E|, if they went on as they do there.
/// @param values of the lattice; their bounds hold for the crossings.
/// @param threads >= 1; the result does not depend on it.
/// @return by axis, then as for_each_edge visits them.
std::deque<RidgeCrossing> ridge_crossings(const Lattice& lattice, const RidgeValues& values,
                                          unsigned threads = 1);

}  // namespace affskel::core
