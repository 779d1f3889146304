#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/vec3.h"
#include "core/lattice/lattice.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

struct LimbMiddlesInput {
  const Lattice& lattice;
  std::span<const float> radius;           ///< per sample point: distance to the surface, spacings
  std::span<const Segment> segments;       ///< of lines through limbs
  std::span<const std::uint32_t> nearest;  ///< per sample point: its vertex, or DualComplex::kNone
  ExecutionContext* context = nullptr;
};

/// Moves lines to the middle of the limbs that they run through.  The ridge of E lies nearer to the inner side of a
/// bend: on a torus, where least caps are cut.  A vertex goes, across its line, to the centroid of the sample points in
/// a ball about it that are nearest to its stretch of the line.  With balls of 1.6 local radii the centroid of a bent
/// tube is on its axis to second order in the curvature: what lies outwards is more, what lies farther along the bend is
/// more inwards.  In a flat limb, whose middle is a sheet, nothing pulls along the sheet.  Ends and joints stay.
/// @param places per vertex, frame coordinates over the spacing.
/// @throws CoreError kCancelled when the context asks to stop.
std::vector<Vec3> limb_middles(const LimbMiddlesInput& input, std::vector<Vec3> places);

}  // namespace affskel::core
