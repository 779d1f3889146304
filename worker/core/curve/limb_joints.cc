#include "core/curve/limb_joints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

// Radii of the joint's ball: as far as a limb that leaves the trunk askew is still in it, and how much of it then tells
// its axis.
constexpr double kLeave = 1.5, kAxis = 2;

// Lines that are nearly parallel say nothing of where along them they meet: the place that was, by this weight of a
// line's, does.
constexpr double kStay = 0.02;

// A branch seen from one of its joints.
struct Leaving {
  std::vector<std::uint32_t>* line = nullptr;
  bool from_last = false;
  std::size_t inside = 0;  // vertices near the joint, itself with them
  Vec3 along;              // unit; 0 where it has no stretch outside

  std::size_t count() const { return line->size(); }
  std::uint32_t vertex(std::size_t n) const { return (*line)[from_last ? count() - 1 - n : n]; }
};

// The x that minimises the sum of the squared distances to lines through p along unit d, and of kStay of that to
// `place`; by Cramer's rule.
Vec3 nearest_to_lines(const std::vector<std::array<Vec3, 2>>& lines, const Vec3& place) {
  std::array<Vec3, 3> rows{Vec3{kStay, 0, 0}, {0, kStay, 0}, {0, 0, kStay}};
  Vec3 right = kStay * place;
  for (const auto& [p, d] : lines) {
    rows[0] = rows[0] + (Vec3{1, 0, 0} - d.x * d);
    rows[1] = rows[1] + (Vec3{0, 1, 0} - d.y * d);
    rows[2] = rows[2] + (Vec3{0, 0, 1} - d.z * d);
    right = right + (p - dot(p, d) * d);
  }
  // The matrix is symmetric: its rows are its columns.
  const double det = dot(rows[0], cross(rows[1], rows[2]));
  return {dot(right, cross(rows[1], rows[2])) / det, dot(rows[0], cross(right, rows[2])) / det,
          dot(rows[0], cross(rows[1], right)) / det};
}

class Joints {
 public:
  Joints(std::span<const Segment> segments, std::span<const double> ball, std::vector<Vec3> places)
      : ball_(ball),
        places_(std::move(places)),
        lines_(polylines(places_.size(), segments)),
        at_(places_.size()) {
    for (auto& line : lines_) {
      at_[line.front()].push_back({&line, false, 0, {}});
      at_[line.back()].push_back({&line, true, 0, {}});
    }
  }

  std::vector<Vec3> run() {
    for (std::uint32_t v = 0; v < at_.size(); ++v)
      if (at_[v].size() > 2) move(v);
    return std::move(places_);
  }

 private:
  void look(std::uint32_t joint, Leaving& branch) const {
    const Vec3 centre = places_[joint];
    std::size_t n = 1;
    while (n < branch.count() && norm(places_[branch.vertex(n)] - centre) < kLeave * ball_[joint]) ++n;
    branch.inside = n;
    branch.along = {};
    // Not into the ball about another joint.
    const std::uint32_t end = branch.vertex(branch.count() - 1);
    const double other = at_[end].size() > 2 ? ball_[end] : 0;
    const auto may_go = [&](std::size_t to) {
      return to < branch.count() && norm(places_[branch.vertex(to)] - places_[end]) >= other;
    };
    if (!may_go(n) || !may_go(n + 1)) return;
    const Vec3 from = places_[branch.vertex(n)];
    std::size_t to = n + 1;
    while (may_go(to + 1) && norm(places_[branch.vertex(to)] - from) < kAxis * ball_[joint]) ++to;
    const Vec3 way = places_[branch.vertex(to)] - from;
    if (norm(way) > 0) branch.along = (1 / norm(way)) * way;
  }

  void move(std::uint32_t joint) {
    std::vector<std::array<Vec3, 2>> axes;
    for (Leaving& branch : at_[joint]) {
      look(joint, branch);
      if (norm(branch.along) > 0) axes.push_back({places_[branch.vertex(branch.inside)], branch.along});
    }
    if (axes.size() < 2) return;
    const Vec3 place = nearest_to_lines(axes, places_[joint]);
    if (!(norm(place - places_[joint]) < ball_[joint])) return;
    places_[joint] = place;
    for (const Leaving& branch : at_[joint]) draw(place, branch);
  }

  // Straight, with the vertices evenly spaced, to the first outside, or the last of the branch.
  void draw(const Vec3& joint, const Leaving& branch) {
    const std::size_t last = std::min(branch.inside, branch.count() - 1);
    const Vec3 way = places_[branch.vertex(last)] - joint;
    for (std::size_t n = 1; n < last; ++n)
      places_[branch.vertex(n)] = joint + (static_cast<double>(n) / static_cast<double>(last)) * way;
  }

  std::span<const double> ball_;
  std::vector<Vec3> places_;
  std::vector<std::vector<std::uint32_t>> lines_;
  std::vector<std::vector<Leaving>> at_;  // per vertex: the branches that begin or end there
};

}  // namespace

std::vector<Vec3> limb_joints(std::span<const Segment> segments, std::span<const double> ball,
                              std::vector<Vec3> places) {
  return Joints(segments, ball, std::move(places)).run();
}

}  // namespace affskel::core
