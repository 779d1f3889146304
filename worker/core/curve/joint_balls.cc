#include "core/curve/joint_balls.h"

#include <algorithm>
#include <cstddef>

#include "core/mesh/polylines.h"

namespace affskel::core {

bool JointBalls::hold(const Vec3& at) const {
  if (norm(at - joint) >= kNear * size) return false;
  for (std::size_t n = 0; n < centres.size(); ++n)
    if (norm(at - centres[n]) < kNear * radii[n]) return true;
  return false;
}

std::vector<JointBalls> joint_balls(std::span<const Vec3> places,
                                    std::span<const std::vector<std::uint32_t>> lines,
                                    std::span<const double> ball) {
  std::vector<JointBalls> result;
  for (std::size_t v = 0; v < places.size(); ++v)
    result.push_back({places[v], ball[v], {places[v]}, {ball[v]}});
  for (const auto& line : lines) {
    for (const bool from_last : {false, true}) {
      const auto at = [&](std::size_t n) { return point_from(from_last, line, n); };
      JointBalls& joint = result[at(0)];
      for (std::size_t n = 1; n < line.size() && norm(places[at(n)] - places[at(0)]) < ball[at(n)]; ++n) {
        joint.size = std::max(joint.size, ball[at(n)]);
        joint.centres.push_back(places[at(n)]);
        joint.radii.push_back(ball[at(n)]);
      }
    }
  }
  return result;
}

}  // namespace affskel::core
