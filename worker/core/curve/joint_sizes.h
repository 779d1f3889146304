#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"

namespace affskel::core {

/// How large each joint is: as the largest ball about a vertex of its lines, from there on, that holds it.  The ball about
/// the joint itself changes fast where it slides along a trunk to where that narrows; the largest one does not.
/// @param lines see polylines(), by numbers in places.
/// @param ball per vertex.
/// @return per vertex; of one where no line ends its own.
std::vector<double> joint_sizes(std::span<const Vec3> places,
                                std::span<const std::vector<std::uint32_t>> lines,
                                std::span<const double> ball);

}  // namespace affskel::core
