#include "core/curve/tubed_limbs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/basis.h"
#include "core/base/median.h"
#include "core/base/none.h"
#include "core/base/unit.h"
#include "core/curve/joint_balls.h"
#include "core/curve/line_ends.h"

namespace affskel::core {
namespace {

constexpr double kRoundest = 1.1;  // balls: half of a tube's end
constexpr std::size_t kRings = 4;  // vertices on either side whose outlines tell that of a joint

class TubeMaker {
 public:
  explicit TubeMaker(const TubedLimbsInput& input) : in_(input) {
    const std::size_t count = in_.places.size();
    tubed_ = {{},
              in_.hubs,
              std::vector<std::uint32_t>(count, kNone),
              std::vector<std::uint32_t>(count, 0),
              std::vector<char>(count, 0),
              std::vector<std::vector<std::uint32_t>>(count)};
    joints_ = joint_balls(in_.places, in_.lines, in_.ball);
  }

  TubedLimbs run() {
    for (const auto& line : in_.lines) add(line);
    for (std::uint32_t v = 0; v < in_.places.size(); ++v) {
      if (tubed_.at_joint[v].size() < 3 && !tubed_.hubs.at(v))
        tubed_.at_joint[v].clear();
      else
        tubed_.limb_of[v] = kNone;
    }
    for (TubedLimb& limb : tubed_.limbs) {
      if (limb.vertices.empty() || (!tubed_.is_joint(limb.ends[0]) && !tubed_.is_joint(limb.ends[1])))
        continue;
      add_rings(limb);
      go_on_into_joints(limb);
    }
    return std::move(tubed_);
  }

 private:
  void add(const std::vector<std::uint32_t>& line) {
    const auto number = static_cast<std::uint32_t>(tubed_.limbs.size());
    tubed_.limbs.push_back(cut(line));
    const TubedLimb& limb = tubed_.limbs.back();
    for (std::uint32_t n = 0; n < limb.vertices.size(); ++n) {
      tubed_.limb_of[limb.vertices[n]] = number;
      tubed_.rank[limb.vertices[n]] = n;
    }
    if (!limb.vertices.empty())
      for (const std::uint32_t v : limb.ends) tubed_.at_joint[v].push_back(number);
  }

  // What of a line is no hub's.
  TubedLimb cut(const std::vector<std::uint32_t>& line) {
    const auto is_limbs = [&](std::uint32_t v) { return !tubed_.hubs.at(v); };
    TubedLimb limb{{}, {line.front(), line.back()}};
    for (std::uint32_t& end : limb.ends)
      if (const LimbHub* hub = tubed_.hubs.at(end)) end = hub->joint;
    const auto last = std::find_if(line.rbegin(), line.rend(), is_limbs).base();
    const auto first = std::find_if(line.begin(), last, is_limbs);
    if (last - first > 1) {
      limb.vertices.assign(first, last);
      return limb;
    }
    const std::uint32_t hub = tubed_.hubs.of[is_limbs(line.front()) ? line.back() : line.front()];
    for (std::size_t n = 1; n + 1 < line.size(); ++n) tubed_.hubs.of[line[n]] = hub;
    return limb;
  }

  // The planes turn with the line, and not about it, so that outlines can be compared.
  void add_rings(TubedLimb& limb) const {
    const auto& line = limb.vertices;
    Vec3 before;
    for (std::size_t n = 0; n < line.size(); ++n) {
      const double ball = in_.ball[line[n]];
      const Vec3 t = direction_in_ball(in_.places, line, n, ball);
      Vec3 u = unit(before - dot(before, t) * t);
      if (u == Vec3{}) u = unit_beside(t);
      before = u;
      TubeRing ring{u, cross(t, u), {}};
      ring.ellipse = in_.ellipse_at(in_.places[line[n]], ring.u, ring.v, ball);
      ring.thickness = std::clamp(ring.ellipse.radius(), ball, kRoundest * ball);
      limb.rings.push_back(ring);
    }
  }

  // How many vertices from an end lie near the joint there; 0 where none is.
  std::size_t in_joint(const TubedLimb& limb, std::size_t end) const {
    const std::uint32_t joint = limb.ends[end];
    if (!tubed_.is_joint(joint)) return 0;
    std::size_t count = 1;
    while (!tubed_.hubs.at(joint) && count + 1 < limb.vertices.size() &&
           joints_[joint].hold(in_.places[limb.at(end, count)]))
      ++count;
    return count;
  }

  struct Free {
    std::array<std::size_t, 2> from;  // vertices from either end, where it leaves its joint
    bool is_any = true;               // else all of it lies in joints
  };

  // Where a limb leaves its joints: vertices from either end; where it does not, its middle, or its free end.
  Free free_part(const TubedLimb& limb) const {
    const std::size_t last = limb.vertices.size() - 1;
    Free free{{in_joint(limb, 0), in_joint(limb, 1)}};
    if (free.from[0] + free.from[1] > last) {
      free.is_any = false;
      free.from[0] = last * free.from[0] / (free.from[0] + free.from[1]);
      free.from[1] = last - free.from[0];
      return free;
    }
    std::vector<double> radii;
    for (std::size_t n = free.from[0]; n + free.from[1] <= last; ++n)
      radii.push_back(limb.rings[n].ellipse.radius());
    const double open = kClearlyThicker * median(std::move(radii));
    for (std::size_t end = 0; end < 2; ++end)
      while (free.from[end] > 0 && free.from[0] + free.from[1] < last &&
             limb.rings[limb.index(end, free.from[end])].ellipse.radius() > open)
        ++free.from[end];
    return free;
  }

  // What it is there, and as its ring.
  TubeRing leaving(const TubedLimb& limb, const Free& free, std::size_t end) const {
    const std::size_t last = limb.vertices.size() - 1, n = limb.index(end, free.from[end]);
    TubeRing ring = limb.rings[n];
    if (!free.is_any) {
      ring.ellipse = {1 / (ring.thickness * ring.thickness), 0, 0};
      return ring;
    }
    const std::size_t low = std::max(free.from[0], n < kRings ? 0 : n - kRings);
    const std::size_t high = std::min(last - free.from[1], n + kRings);
    const double share = 1 / static_cast<double>(high - low + 1);
    ring.ellipse = {};
    for (std::size_t k = low; k <= high; ++k) {
      const LimbEllipse& one = limb.rings[k].ellipse;
      ring.ellipse.mean += share * one.mean;
      ring.ellipse.cosine += share * one.cosine;
      ring.ellipse.sine += share * one.sine;
    }
    return ring;
  }

  // How far a limb goes on beyond its joint: as half of a tube's end, to where the limbs there part from each other.
  double beyond_joint(const TubedLimb& limb, std::size_t end, const TubeRing& leaving) const {
    const LineEnd self{static_cast<std::uint32_t>(&limb - tubed_.limbs.data()), end == 1};
    const TubeRing& ring = limb.rings[limb.index(end, 0)];
    const Vec3 out = (end == 0 ? -1. : 1.) * cross(ring.u, ring.v);
    double sum = 0, count = 0;
    for (const LimbFork& fork : in_.forks[limb.ends[end]]) {
      const Vec3 way = fork.place - in_.places[limb.ends[end]];
      const double along = dot(way, out), rest = 1 - leaving.across(way), weight = ahead(way, out);
      const bool is_own = fork.limbs[0] == self || fork.limbs[1] == self;
      if (is_own || along <= 0 || rest <= 0 || !(weight > 0)) continue;
      sum += weight * along / std::sqrt(rest);
      count += weight;
    }
    return count > 0 ? std::min(leaving.thickness, sum / count) : leaving.thickness;
  }

  void go_on_into_joints(TubedLimb& limb) {
    const Free free = free_part(limb);
    const std::array<TubeRing, 2> leaving{this->leaving(limb, free, 0), this->leaving(limb, free, 1)};
    for (std::size_t end = 0; end < 2; ++end) {
      for (std::size_t n = 0; n < free.from[end]; ++n) {
        TubeRing& ring = limb.rings[limb.index(end, n)];
        ring.ellipse = leaving[end].ellipse;
        ring.thickness = leaving[end].thickness;
        tubed_.is_shared[limb.at(end, n)] = 1;
      }
      if (tubed_.is_joint(limb.ends[end]) && !tubed_.hubs.at(limb.ends[end]))
        limb.rings[limb.index(end, 0)].thickness = beyond_joint(limb, end, leaving[end]);
    }
    std::vector<double> radii;
    for (std::size_t n = 0; n < limb.vertices.size(); ++n) {
      const TubeRing& ring = limb.rings[n];
      const auto& [mean, cosine, sine] = ring.ellipse;
      const double most =
          std::max(ring.thickness, 1 / std::sqrt(mean - std::sqrt(cosine * cosine + sine * sine)));
      limb.box.include(in_.places[limb.vertices[n]] - Vec3{most, most, most});
      limb.box.include(in_.places[limb.vertices[n]] + Vec3{most, most, most});
      if (!tubed_.is_joint(limb.vertices[n])) radii.push_back(in_.radius[limb.vertices[n]]);
    }
    if (!radii.empty()) limb.size = median(std::move(radii));
  }

  const TubedLimbsInput& in_;
  TubedLimbs tubed_;
  std::vector<JointBalls> joints_;  // per vertex
};

}  // namespace

double TubeRing::across(const Vec3& way) const {
  const double a = dot(way, u), b = dot(way, v);
  const auto& [mean, cosine, sine] = ellipse;
  return mean * (a * a + b * b) + cosine * (a * a - b * b) + sine * 2 * a * b;
}

TubedLimbs tubed_limbs(const TubedLimbsInput& input) {
  return TubeMaker(input).run();
}

}  // namespace affskel::core
