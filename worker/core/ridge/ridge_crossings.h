#pragma once

#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/lattice/lattice_edges.h"
#include "core/lattice/solid_parts.h"
#include "core/ridge/smoothed_derivatives.h"

namespace affskel::core {

/// A point of the ridge surface of E on a lattice edge.
struct RidgeCrossing {
  LatticeEdge edge;
  Vec3 position;            ///< frame coordinates, on the edge and in the solid
  Vec3 normal;              ///< of the sheet: e, unit, of either sign
  double erosion = 0;       ///< E, volume
  double strength = 0;      ///< s, radians
  double ratio = 0;         ///< lambda_2 / lambda_1: 1 where the solid is round, 0 in a flat sheet
  double roundness = 0;     ///< lambda_3 / lambda_1: 1 at the centre of a ball, at most 0 on a limb's axis
  double area = 0;          ///< of the section: mean |grad_x E| of the edge's ends, mesh units squared
  Vec3 normal_a, normal_b;  ///< unit normals of the level surfaces one width before and behind, along e
};

struct RidgeCrossingOptions {
  double min_strength = 0.5;  ///< least s, radians, > 0
  /// Least E, as a share of the volume of the sample points' cells in the part, 0 .. 1.
  double min_erosion = 0.002;
};

/// Where the ridge surfaces of E cross lattice edges (height ridges of codimension 1: Haralick 1983; Eberly
/// 1996, chapter 3): grad P is orthogonal to e, the eigenvector of the least eigenvalue lambda_1 < 0 of P's
/// Hessian.  e is oriented alike at both ends of an edge; a sign change of e . grad P is placed by linear
/// interpolation.  The same for any increasing function P of E, but for the smoothing.
///
/// The strength s = -lambda E / |grad E|^2, lambda the eigenvalue for E along e, is the angle by which the
/// normals of the level surfaces turn over one depth d = E / |grad E|, if they went on as they do there.
/// @param derivatives of this field.
/// @return by axis, then as for_each_edge visits them.
/// @throws CoreError kBadInput when an option is out of range.
std::vector<RidgeCrossing> ridge_crossings(const Lattice& lattice, const SolidParts& parts,
                                           const FrameField& field,
                                           std::span<const PointDerivatives> derivatives,
                                           const RidgeCrossingOptions& options = {});

}  // namespace affskel::core
