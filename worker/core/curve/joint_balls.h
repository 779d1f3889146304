#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"

namespace affskel::core {

/// What a joint takes up: the balls about vertices of its lines, from there on, that hold it.  The ball about the joint
/// itself changes fast where it slides along a trunk to where that narrows; these together do not.
struct JointBalls {
  Vec3 joint;
  double size = 0;  ///< the largest one's
  std::vector<Vec3> centres = {};
  std::vector<double> radii = {};

  /// Times: nearer to a joint a section of a limb has a part of the other limbs.
  static constexpr double kNear = 1.22;

  /// Whether a place lies within kNear radii of one of them, and of the joint, by the largest one's.
  bool hold(const Vec3& at) const;
};

/// @param lines see polylines(), by numbers in places.
/// @param ball per vertex.
/// @return per vertex; of one where no line ends its own.
std::vector<JointBalls> joint_balls(std::span<const Vec3> places,
                                    std::span<const std::vector<std::uint32_t>> lines,
                                    std::span<const double> ball);

}  // namespace affskel::core
