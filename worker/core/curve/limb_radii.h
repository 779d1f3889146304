#pragma once

#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

struct LimbRadiiInput {
  std::span<const Vec3> places;       ///< per vertex
  std::span<const Segment> segments;  ///< as for polylines()
  std::span<const double> share;      ///< per vertex: of the volume, what belongs to it
  std::span<const double> slice;      ///< per vertex: of the volume, what is nearest to it
  std::span<const double>
      ball;  ///< per vertex: distance to the surface; a free end reaches so far beyond itself
  double volume = 0;
};

/// How thick the solid is about the lines of its curve skeleton: the radius of the tube that has, over a few vertices on
/// either side, the volume that belongs to them.  A vertex that has less than its slice lies in a thicker limb, as far as
/// that goes: there its own is as thick as where it comes out.  The optimal section tells no thickness: all planes through a place
/// on the axis of a tube cut off as much, however they are tilted.
/// @return per vertex; 0 for one without a line, and for a body that limbs hang on (see limb_hubs()) that of a ball as large.
std::vector<double> limb_radii(const LimbRadiiInput& input);

}  // namespace affskel::core
