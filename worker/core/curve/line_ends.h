#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/curve/limb_surface.h"

namespace affskel::core {

/// The direction of a line, `gap` beyond its first vertex: it bends on there as it does over its first two stretches, as far
/// as it is known and bends so within the first.  0 where it has none.
Vec3 outward(std::span<const Vec3> places, std::span<const std::uint32_t> line, double stretch, double gap);

/// The direction of a line at its n-th vertex, by what lies in a ball about it.  0 where it has none.
Vec3 direction_in_ball(std::span<const Vec3> places, std::span<const std::uint32_t> line, std::size_t n,
                       double ball);

struct LineEndInput {
  const LimbSurface& surface;                ///< of the solid
  double spacing = 0;                        ///< of the lattice
  std::span<const std::uint32_t> line = {};  ///< from the end on
  std::size_t in_joint = 0;                  ///< vertices at its other end
  Vec3 tip;                                  ///< where the end is known to lie about
};

/// Draws the free end of a line, straight on.  A round one ends at its centre: where the distance to the surface begins to
/// fall by more than half of the way.  The flat one of a bar ends at its face: beyond the centre sections are as large as
/// before.  At a bar's end lines lead into a corner, along which that distance falls slowly; these begin anew where they
/// leave the middle, as do those that turn aside in a plate, but for limbs that bend or taper there, whose wall is straight
/// on.  The others go straight on from where the ball of a blunt end is whole.
void draw_end(const LineEndInput& input, std::vector<Vec3>& places);

}  // namespace affskel::core
