#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"

namespace affskel::core {

struct LimbSlices {
  std::span<const Vec3> places;                       ///< per vertex
  std::span<const std::vector<std::uint32_t>> lines;  ///< see polylines()
  std::span<const double> slice;                      ///< per vertex: of the volume, what is nearest to it
  /// Per vertex: distance to the surface; a free end reaches so far beyond itself.
  std::span<const double> ball;
  double volume = 0;
};

/// How thick the solid is about lines, whatever belongs to them: the radius of the tube that has, over a few vertices on
/// either side, the volume that is nearest to them.
/// @return per vertex; 0 for one without a line.
std::vector<double> slice_radii(const LimbSlices& input);

struct LimbRadiiInput {
  std::span<const std::vector<std::uint32_t>> lines;  ///< see polylines()
  std::span<const double> share;                      ///< per vertex: of the volume, what belongs to it
  std::span<const double> slice;                      ///< per vertex: of the volume, what is nearest to it
  std::span<const double> tube;                       ///< per vertex: see slice_radii()
  std::span<const double> ball;                       ///< per vertex: distance to the surface
  std::span<const double> area;                       ///< per vertex: of the section across the line
  std::span<const char> in_joint;  ///< per vertex: whether that section reaches into other limbs
  double volume = 0;
};

/// How thick limbs are: the radius of a disc as large as the section, as a mean over a few vertices on either side.  Where that
/// reaches into other limbs, or is clearly more than the tube and the ball there, or others have what is nearest to the vertex, a limb is as thick
/// as where it comes out; a line that nowhere does is as thick as the larger of both: of a short link others have most.  The optimal section tells no thickness: all planes
/// through a place on the axis of a tube cut off as much, however they are tilted.
/// @return per vertex; for one without a line, and for a body that limbs hang on (see limb_hubs()), that of a ball as large.
std::vector<double> limb_radii(const LimbRadiiInput& input);

}  // namespace affskel::core
