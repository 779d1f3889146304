#include "core/curve/limb_tubes.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

// Of limbs that are about as thick neither is a part of the other.
constexpr double kClearly = 1.1;

constexpr double kUnreached = std::numeric_limits<double>::infinity();

}  // namespace

LimbTubes::LimbTubes(std::span<const Vec3> places, std::span<const Segment> segments,
                     std::span<const double> ball, std::span<const double> radius)
    : places_(places),
      ball_(ball),
      radius_(radius),
      limb_of_(places.size(), kNone),
      at_joint_(places.size()) {
  for (auto& line : polylines(places.size(), segments)) {
    const auto number = static_cast<std::uint32_t>(limbs_.size());
    for (const std::uint32_t v : line) limb_of_[v] = number;
    for (const std::uint32_t v : {line.front(), line.back()}) at_joint_[v].push_back(number);
    limbs_.push_back({.vertices = std::move(line)});
  }
  for (std::uint32_t v = 0; v < places.size(); ++v) {
    if (at_joint_[v].size() < 3)
      at_joint_[v].clear();
    else
      limb_of_[v] = kNone;
  }
  for (Limb& limb : limbs_) measure(limb);
  for (Limb& limb : limbs_)
    for (std::size_t end = 0; end < 2; ++end) compare(limb, end);
  for (Limb& limb : limbs_) find_within(limb);
  in_thicker_.assign(places.size(), kNone);
  for (const Limb& limb : limbs_)
    for (const auto& thicker : limb.thicker)
      for (const std::uint32_t other : thicker)
        for (const std::uint32_t v : limb.vertices)
          if (in_thicker_[v] == kNone && !is_joint(v) && holds(limbs_[other], places[v]))
            in_thicker_[v] = other;
}

double LimbTubes::thickness_of(std::uint32_t vertex) const {
  return std::clamp(radius_[vertex], ball_[vertex], kRoundest * ball_[vertex]);
}

void LimbTubes::measure(Limb& limb) const {
  const auto& line = limb.vertices;
  for (const std::uint32_t v : line) limb.tube.push_back(thickness_of(v));
  std::vector<double> sorted = limb.tube;
  std::sort(sorted.begin(), sorted.end());
  limb.size = sorted[sorted.size() / 2];
  for (std::size_t end = 0; end < 2; ++end) {
    const std::uint32_t joint = limb.end(end);
    if (!is_joint(joint)) continue;
    const auto at = [&](std::size_t n) { return end == 0 ? n : line.size() - 1 - n; };
    std::size_t first = 1;
    while (first < line.size() && norm(places_[line[at(first)]] - places_[joint]) < kJoint * ball_[joint])
      ++first;
    // In a wide chest an arm's line has large balls beyond the joint, too.
    const double thickness =
        std::min(kRoundest * limb.size, first < line.size() ? thickness_of(line[at(first)]) : sorted.front());
    for (std::size_t n = 0; n < first; ++n)
      limb.tube[at(n)] = std::min(kRoundest * ball_[line[at(n)]], thickness);
  }
  for (std::size_t n = 0; n < line.size(); ++n) {
    const Vec3 reach{limb.tube[n], limb.tube[n], limb.tube[n]};
    limb.box.include(places_[line[n]] - reach);
    limb.box.include(places_[line[n]] + reach);
  }
}

void LimbTubes::compare(Limb& limb, std::size_t end) const {
  std::vector<std::uint32_t> round = at_joint_[limb.end(end)];
  std::stable_sort(round.begin(), round.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return limbs_[a].size > limbs_[b].size; });
  for (const std::uint32_t other : round) {
    if (&limbs_[other] == &limb) continue;
    const bool is_thicker = limbs_[other].size > kClearly * limb.size;
    (is_thicker ? limb.thicker : limb.others)[end].push_back(other);
  }
}

// Whether a link is a part of a longer limb, of several of the thickest.
void LimbTubes::find_within(Limb& limb) const {
  if (!is_joint(limb.end(0)) || !is_joint(limb.end(1))) return;
  double thickest = 0;
  for (std::size_t end = 0; end < 2; ++end) {
    for (const std::uint32_t other : at_joint_[limb.end(end)]) {
      const Limb& longer = limbs_[other];
      if (longer.vertices.size() <= limb.vertices.size() || longer.within != kNone || longer.size <= thickest)
        continue;
      if (!std::all_of(limb.vertices.begin(), limb.vertices.end(),
                       [&](std::uint32_t v) { return holds(longer, places_[v]); }))
        continue;
      limb.within = other;
      thickest = longer.size;
    }
  }
}

bool LimbTubes::holds(const Limb& limb, const Vec3& at) const {
  if (!limb.box.meets(Box{{at.x, at.y, at.z}, {at.x, at.y, at.z}})) return false;
  for (std::size_t n = 0; n < limb.vertices.size(); ++n) {
    const Vec3 way = at - places_[limb.vertices[n]];
    if (dot(way, way) < limb.tube[n] * limb.tube[n]) return true;
  }
  return false;
}

// The first whose tube holds a place.
std::uint32_t LimbTubes::holder(const std::array<std::vector<std::uint32_t>, 2>& limbs,
                                const Vec3& at) const {
  for (const auto& round : limbs)
    for (const std::uint32_t limb : round)
      if (holds(limbs_[limb], at)) return limb;
  return kNone;
}

// Joints left out; where there is nothing else, what was nearest before.
std::uint32_t LimbTubes::nearest_of(std::span<const std::uint32_t> vertices, const Vec3& at,
                                    std::uint32_t before) const {
  double least = kUnreached;
  std::uint32_t nearest = before;
  for (const std::uint32_t v : vertices) {
    const Vec3 way = at - places_[v];
    if (is_joint(v) || dot(way, way) >= least) continue;
    least = dot(way, way);
    nearest = v;
  }
  return nearest;
}

// A joint's next vertex, the nearest that is none; the joint where there is none.
std::uint32_t LimbTubes::off_joint(std::uint32_t vertex, const Vec3& at) const {
  std::vector<std::uint32_t> next;
  for (const std::uint32_t n : at_joint_[vertex]) {
    const auto& line = limbs_[n].vertices;
    if (line.front() == vertex) next.push_back(line[1]);
    if (line.back() == vertex) next.push_back(line[line.size() - 2]);
  }
  return nearest_of(next, at, vertex);
}

std::uint32_t LimbTubes::vertex_of(const Vec3& at, std::uint32_t nearest) const {
  if (is_joint(nearest)) nearest = off_joint(nearest, at);
  if (limb_of_[nearest] == kNone) return nearest;
  const Limb& limb = limbs_[limb_of_[nearest]];
  if (limb.within != kNone) return nearest_of(limbs_[limb.within].vertices, at, nearest);
  if (const std::uint32_t thicker = holder(limb.thicker, at); thicker != kNone)
    return nearest_of(limbs_[thicker].vertices, at, nearest);
  std::uint32_t owner = holder(limb.others, at);
  if (owner == kNone) owner = in_thicker_[nearest];
  return owner == kNone || holds(limb, at) ? nearest : nearest_of(limbs_[owner].vertices, at, nearest);
}

}  // namespace affskel::core
