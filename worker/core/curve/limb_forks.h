#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/curve/limb_sections.h"
#include "core/mesh/polylines.h"

namespace affskel::core {

/// Where two limbs of a joint part.  Out along both, as far on the one as on the other, each sees the other until the solid
/// ends between them: in the crotch, in an armpit.  Noise moves that place as little as the surface itself, however it
/// moves the joint.
struct LimbFork {
  std::array<LineEnd, 2> limbs;
  Vec3 place;  ///< between them, where the surface is first
};

/// How much what lies that way is ahead along a direction or against it, a unit vector: the squared cosine above a quarter,
/// 0 where it is more than 60 degrees aside.
double ahead(const Vec3& way, const Vec3& direction);

/// @param lines see polylines(), by numbers in places.
/// @param step along lines, > 0.
/// @param left_out per vertex: whether there forks are not asked for, as in a hub of hundreds of limbs; or empty.
/// @return per vertex: of the joint there; none of limbs that see each other all the way.
std::vector<std::vector<LimbFork>> limb_forks(std::span<const Vec3> places,
                                              std::span<const std::vector<std::uint32_t>> lines,
                                              const LimbSections& sections, double step,
                                              std::span<const char> left_out = {});

/// How many vertices of a limb, from its joint on, have sections that reach into the others: they part from it no sooner.
/// @param forks of the joint at this end.
std::size_t before_forks(std::span<const Vec3> places, std::span<const std::vector<std::uint32_t>> lines,
                         std::span<const LimbFork> forks, const LineEnd& limb);

}  // namespace affskel::core
