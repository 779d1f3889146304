#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/curve/joint_balls.h"

namespace affskel::core {

constexpr std::uint32_t kNoThickJoint = std::numeric_limits<std::uint32_t>::max();

/// Joints that are clearly thicker than all limbs that meet there: bodies of their own, that limbs hang on, as an elephant's
/// trunk of four legs and a neck, or a jar's belly without a foot.  Joints between which a line as thick lies in their balls
/// are of one body: noise tells how many these are.  A limb that only ends near its balls counts as well: hips beside a body's
/// trunk are a part of that.
/// @param lines see polylines(), by numbers in places.
/// @param size per line: how thick it is, all in all.
/// @param joints see joint_balls().  Gives the largest joint of a body the balls of the others.
/// @return per vertex: that joint; kNoThickJoint where there is none.
std::vector<std::uint32_t> thick_joints(std::span<const Vec3> places,
                                        std::span<const std::vector<std::uint32_t>> lines,
                                        std::span<const double> size, std::span<JointBalls> joints);

}  // namespace affskel::core
