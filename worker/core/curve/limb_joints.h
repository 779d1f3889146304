#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Moves the places where lines meet to where the axes of their limbs do, and draws the lines straight from there to
/// where they leave the largest ball about the joint.  Within it a limb has no middle of its own: the ridge of E turns
/// from the limb into the trunk, and its lines sag.  An axis is the line through the place where a branch leaves the
/// ball, along its next stretch; the joint is the place nearest to all (least squares), as long as it is in the ball.
/// What is drawn lies in the ball, and so in the solid.
/// @param segments as for polylines().
/// @param ball per vertex: its distance to the surface, in the unit of the places.
/// @param places per vertex.
/// @return the places, in which all but those near joints are the same.
std::vector<Vec3> limb_joints(std::span<const Segment> segments, std::span<const double> ball,
                              std::vector<Vec3> places);

}  // namespace affskel::core
