#include "core/curve/limb_tubes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/basis.h"
#include "core/base/unit.h"
#include "core/curve/joint_balls.h"
#include "core/curve/line_ends.h"
#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

// Of limbs that are about as thick neither is a part of the other; a section that is larger than most is open.
constexpr double kClearly = 1.1;

constexpr std::size_t kRings = 4;  // vertices on either side whose outlines tell that of a joint

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

// Of a way from the middle of a ring; 1 on its ellipse.
double LimbTubes::across(const Ring& ring, const Vec3& way) {
  const double u = dot(way, ring.u), v = dot(way, ring.v);
  const auto& [mean, cosine, sine] = ring.ellipse;
  return mean * (u * u + v * v) + cosine * (u * u - v * v) + sine * 2 * u * v;
}

LimbTubes::LimbTubes(std::span<const Vec3> places, std::span<const Segment> segments,
                     std::span<const double> ball, std::span<const double> radius,
                     std::span<const std::vector<LimbFork>> forks, LimbHubs hubs, const EllipseAt& ellipse_at)
    : places_(places),
      ball_(ball),
      radius_(radius),
      forks_(forks),
      hubs_(std::move(hubs)),
      limb_of_(places.size(), kNone),
      rank_(places.size(), 0),
      is_shared_(places.size(), 0),
      at_joint_(places.size()) {
  auto lines = polylines(places.size(), segments);
  joints_ = joint_balls(places, lines, ball);
  for (auto& line : lines) {
    const auto number = static_cast<std::uint32_t>(limbs_.size());
    limbs_.push_back(cut(std::move(line)));
    const Limb& limb = limbs_.back();
    for (std::uint32_t n = 0; n < limb.vertices.size(); ++n) {
      limb_of_[limb.vertices[n]] = number;
      rank_[limb.vertices[n]] = n;
    }
    if (!limb.vertices.empty())
      for (const std::uint32_t v : limb.ends) at_joint_[v].push_back(number);
  }
  for (std::uint32_t v = 0; v < places.size(); ++v) {
    if (at_joint_[v].size() < 3 && !hubs_.at(v))
      at_joint_[v].clear();
    else
      limb_of_[v] = kNone;
  }
  for (Limb& limb : limbs_) {
    if (limb.vertices.empty() || (!is_joint(limb.ends[0]) && !is_joint(limb.ends[1]))) continue;
    add_rings(ellipse_at, limb);
    go_on_into_joints(limb);
  }
  for (Limb& limb : limbs_)
    for (std::size_t end = 0; end < 2 && !limb.vertices.empty(); ++end) compare(limb, end);
  find_hidden();
  for (const Limb& limb : limbs_)
    for (const auto& thicker : limb.thicker)
      for (const std::uint32_t other : thicker)
        for (const std::uint32_t v : limb.vertices)
          if (!is_shared_[v] && holds(limbs_[other], places[v])) is_shared_[v] = 1;
}

// What of a line is no hub's.
LimbTubes::Limb LimbTubes::cut(std::vector<std::uint32_t> line) {
  const auto is_limbs = [&](std::uint32_t v) { return !hubs_.at(v); };
  Limb limb{{}, {line.front(), line.back()}};
  for (std::uint32_t& end : limb.ends)
    if (const LimbHub* hub = hubs_.at(end)) end = hub->joint;
  const auto last = std::find_if(line.rbegin(), line.rend(), is_limbs).base();
  const auto first = std::find_if(line.begin(), last, is_limbs);
  if (last - first > 1) {
    limb.vertices.assign(first, last);
    return limb;
  }
  const std::uint32_t hub = hubs_.of[is_limbs(line.front()) ? line.back() : line.front()];
  for (std::size_t n = 1; n + 1 < line.size(); ++n) hubs_.of[line[n]] = hub;
  return limb;
}

// The planes turn with the line, and not about it, so that outlines can be compared.
void LimbTubes::add_rings(const EllipseAt& ellipse_at, Limb& limb) const {
  const auto& line = limb.vertices;
  Vec3 before;
  for (std::size_t n = 0; n < line.size(); ++n) {
    const double ball = ball_[line[n]];
    const Vec3 t = direction_in_ball(places_, line, n, ball);
    Vec3 u = unit(before - dot(before, t) * t);
    if (u == Vec3{}) u = unit_beside(t);
    before = u;
    Ring ring{u, cross(t, u), {}};
    ring.ellipse = ellipse_at(places_[line[n]], ring.u, ring.v, LimbSections::kSeen * ball);
    ring.thickness = std::clamp(ring.ellipse.radius(), ball, kRoundest * ball);
    limb.rings.push_back(ring);
  }
}

// How many vertices from an end lie near the joint there; 0 where none is.
std::size_t LimbTubes::in_joint(const Limb& limb, std::size_t end) const {
  const std::uint32_t joint = limb.ends[end];
  if (!is_joint(joint)) return 0;
  std::size_t count = 1;
  while (!hubs_.at(joint) && count + 1 < limb.vertices.size() &&
         joints_[joint].hold(places_[limb.at(end, count)], JointBalls::kNear))
    ++count;
  return count;
}

// Where a limb leaves its joints: vertices from either end; where it does not, its middle, or its free end.
LimbTubes::Free LimbTubes::free_part(const Limb& limb) const {
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
  const double open = kClearly * median(std::move(radii));
  for (std::size_t end = 0; end < 2; ++end)
    while (free.from[end] > 0 && free.from[0] + free.from[1] < last &&
           limb.rings[limb.index(end, free.from[end])].ellipse.radius() > open)
      ++free.from[end];
  return free;
}

// What it is there, and as its ring.
LimbTubes::Ring LimbTubes::leaving(const Limb& limb, const Free& free, std::size_t end) const {
  const std::size_t last = limb.vertices.size() - 1, n = limb.index(end, free.from[end]);
  Ring ring = limb.rings[n];
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
double LimbTubes::beyond_joint(const Limb& limb, std::size_t end, const Ring& leaving) const {
  const LimbFork::End self{static_cast<std::uint32_t>(&limb - limbs_.data()), end == 1};
  const Ring& ring = limb.rings[limb.index(end, 0)];
  const Vec3 out = (end == 0 ? -1. : 1.) * cross(ring.u, ring.v);
  double sum = 0, count = 0;
  for (const LimbFork& fork : forks_[limb.ends[end]]) {
    const Vec3 way = fork.place - places_[limb.ends[end]];
    const double along = dot(way, out), rest = 1 - across(leaving, way), weight = ahead(way, out);
    const bool is_own = fork.limbs[0] == self || fork.limbs[1] == self;
    if (is_own || along <= 0 || rest <= 0 || !(weight > 0)) continue;
    sum += weight * along / std::sqrt(rest);
    count += weight;
  }
  return count > 0 ? std::min(leaving.thickness, sum / count) : leaving.thickness;
}

void LimbTubes::go_on_into_joints(Limb& limb) {
  const Free free = free_part(limb);
  const std::array<Ring, 2> leaving{this->leaving(limb, free, 0), this->leaving(limb, free, 1)};
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t n = 0; n < free.from[end]; ++n) {
      Ring& ring = limb.rings[limb.index(end, n)];
      ring.ellipse = leaving[end].ellipse;
      ring.thickness = leaving[end].thickness;
      is_shared_[limb.at(end, n)] = 1;
    }
    if (is_joint(limb.ends[end]) && !hubs_.at(limb.ends[end]))
      limb.rings[limb.index(end, 0)].thickness = beyond_joint(limb, end, leaving[end]);
  }
  std::vector<double> radii;
  for (std::size_t n = 0; n < limb.vertices.size(); ++n) {
    const Ring& ring = limb.rings[n];
    const auto& [mean, cosine, sine] = ring.ellipse;
    const double most =
        std::max(ring.thickness, 1 / std::sqrt(mean - std::sqrt(cosine * cosine + sine * sine)));
    limb.box.include(places_[limb.vertices[n]] - Vec3{most, most, most});
    limb.box.include(places_[limb.vertices[n]] + Vec3{most, most, most});
    if (!is_joint(limb.vertices[n])) radii.push_back(radius_[limb.vertices[n]]);
  }
  if (!radii.empty()) limb.size = median(std::move(radii));
}

void LimbTubes::compare(Limb& limb, std::size_t end) const {
  std::vector<std::uint32_t> round = at_joint_[limb.ends[end]];
  std::stable_sort(round.begin(), round.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return limbs_[a].size > limbs_[b].size; });
  for (const std::uint32_t other : round) {
    if (&limbs_[other] == &limb) continue;
    const bool is_thicker = limbs_[other].size > kClearly * limb.size;
    (is_thicker ? limb.thicker : limb.others)[end].push_back(other);
  }
  // Only the thickest goes on beyond its joint, and a hub is: a limb begins between two vertices.
  const bool at_hub = hubs_.at(limb.ends[end]) != nullptr;
  if (at_hub || !limb.thicker[end].empty())
    limb.rings[limb.index(end, 0)].thickness =
        (at_hub ? 1 : 0.5) * norm(places_[limb.at(end, 1)] - places_[limb.at(end, 0)]);
}

// Links and loops whose lines lie in the tubes of those that they meet, shorter ones first.
void LimbTubes::find_hidden() {
  std::vector<std::uint32_t> order;
  for (std::uint32_t n = 0; n < limbs_.size(); ++n)
    if (!limbs_[n].vertices.empty() && is_joint(limbs_[n].ends[0]) && is_joint(limbs_[n].ends[1]))
      order.push_back(n);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return limbs_[a].vertices.size() < limbs_[b].vertices.size();
  });
  for (const std::uint32_t n : order) {
    Limb& limb = limbs_[n];
    limb.is_hidden = std::all_of(limb.vertices.begin(), limb.vertices.end(), [&](std::uint32_t v) {
      return outside_hub(limb.ends[0], places_[v]) < 0 || outside_hub(limb.ends[1], places_[v]) < 0 ||
             any_beside(limb, [&](const Limb& other) { return holds(other, places_[v]); });
    });
  }
}

// Whether a limb, not hidden, that meets one fulfils something; thicker ones are asked first.
template <class Fulfils>
bool LimbTubes::any_beside(const Limb& limb, const Fulfils& fulfils) const {
  for (const auto* rounds : {&limb.thicker, &limb.others})
    for (const auto& round : *rounds)
      for (const std::uint32_t other : round)
        if (!limbs_[other].is_hidden && fulfils(limbs_[other])) return true;
  return false;
}

// How far a place is outside the tube at one of its vertices, along the way from there; within it less than 0.
double LimbTubes::depth_below(const Limb& limb, std::size_t n, const Vec3& at) const {
  const Ring& ring = limb.rings[n];
  const Vec3 way = at - places_[limb.vertices[n]];
  const double square = dot(way, way), u = dot(way, ring.u), v = dot(way, ring.v);
  if (!(square > 0)) return -ring.thickness;
  const double along = std::max(0.0, square - u * u - v * v) / (ring.thickness * ring.thickness);
  return std::sqrt(square) * (1 - 1 / std::sqrt(across(ring, way) + along));
}

std::size_t LimbTubes::nearest_in(const Limb& limb, const Vec3& at) const {
  double least = std::numeric_limits<double>::infinity();
  std::size_t nearest = 0;
  for (std::size_t n = 0; n < limb.vertices.size(); ++n) {
    const Vec3 way = at - places_[limb.vertices[n]];
    if (dot(way, way) >= least) continue;
    least = dot(way, way);
    nearest = n;
  }
  return nearest;
}

// Of a joint the vertex beside it, the joint where that is one, too.
std::uint32_t LimbTubes::own_vertex(const Limb& limb, std::size_t n) const {
  const std::size_t last = limb.vertices.size() - 1;
  if (is_joint(limb.vertices[n])) n = n == 0 ? 1 : last - 1;
  return limb.vertices[n];
}

bool LimbTubes::holds(const Limb& limb, const Vec3& at) const {
  return limb.box.squared_distance(at) <= 0 && depth_below(limb, nearest_in(limb, at), at) < 0;
}

// A joint's next vertex, the nearest that is none; the joint where there is none.
std::uint32_t LimbTubes::off_joint(std::uint32_t vertex, const Vec3& at) const {
  double least = std::numeric_limits<double>::infinity();
  std::uint32_t nearest = vertex;
  for (const std::uint32_t n : at_joint_[vertex]) {
    for (std::size_t end = 0; end < 2; ++end) {
      const std::uint32_t next = limbs_[n].at(end, 1);
      const double way = norm(at - places_[next]);
      if (limbs_[n].ends[end] != vertex || is_joint(next) || way >= least) continue;
      least = way;
      nearest = next;
    }
  }
  return nearest;
}

double LimbTubes::outside_hub(std::uint32_t joint, const Vec3& at) const {
  const LimbHub* hub = hubs_.at(joint);
  return hub ? hub->outside(at) : std::numeric_limits<double>::infinity();
}

// What is nearest to a hub's own lines, or to its limbs' within it.
std::uint32_t LimbTubes::about_hub(std::uint32_t joint, const Vec3& at) const {
  double least = outside_hub(joint, at);
  std::uint32_t owner = joint;
  if (least < 0) return owner;
  for (const std::uint32_t number : at_joint_[joint]) {
    const Limb& limb = limbs_[number];
    if (limb.is_hidden || limb.ends[0] == limb.ends[1]) continue;
    const std::size_t n = nearest_in(limb, at);
    const double depth = depth_below(limb, n, at);
    if (depth >= least) continue;
    least = depth;
    owner = own_vertex(limb, n);
  }
  return owner;
}

// It has no more than what the walk along lines takes to it: noise makes some within a body's hips.
bool LimbTubes::is_handle_of(const Limb& loop, const Limb& limb) {
  return loop.ends[0] == loop.ends[1] && loop.size <= limb.size;
}

// Of a vertex and the limbs that meet its own the nearest, which a walk along lines does not come to where it leads away
// from a place first.
std::uint32_t LimbTubes::nearest_beside(std::uint32_t vertex, const Vec3& at) const {
  double least = norm(at - places_[vertex]);
  std::uint32_t nearest = vertex;
  const Limb& limb = limbs_[limb_of_[vertex]];
  any_beside(limb, [&](const Limb& other) {
    if (is_handle_of(other, limb)) return false;
    const std::uint32_t found = own_vertex(other, nearest_in(other, at));
    const double way = norm(at - places_[found]);
    if (way >= least || limb_of_[found] == kNone) return false;
    least = way;
    nearest = found;
    return false;
  });
  return nearest;
}

// Of the thicker limbs that meet one, whose tubes hold a place, the thickest; of those about as thick the one that it lies
// deepest in.
const LimbTubes::Limb* LimbTubes::thicker_about(const Limb& limb, const Vec3& at) const {
  const Limb* found = nullptr;
  double thickest = 0, least = 0;
  for (const auto& round : limb.thicker)
    for (const std::uint32_t number : round) {
      const Limb& other = limbs_[number];
      if (other.is_hidden || kClearly * other.size < thickest || !holds(other, at)) continue;
      const double depth = depth_below(other, nearest_in(other, at), at);
      if (found != nullptr && other.size <= kClearly * thickest && depth >= least) continue;
      thickest = std::max(thickest, other.size);
      found = &other;
      least = depth;
    }
  return found;
}

std::uint32_t LimbTubes::vertex_of(const Vec3& at, std::uint32_t nearest) const {
  if (const LimbHub* hub = hubs_.at(nearest)) return about_hub(hub->joint, at);
  if (is_joint(nearest)) nearest = off_joint(nearest, at);
  if (limb_of_[nearest] == kNone) return nearest;
  if (is_shared_[nearest]) nearest = nearest_beside(nearest, at);
  const Limb& limb = limbs_[limb_of_[nearest]];
  const std::array<double, 2> outside{outside_hub(limb.ends[0], at), outside_hub(limb.ends[1], at)};
  const std::size_t nearer = outside[1] < outside[0] ? 1 : 0;
  if (outside[nearer] < 0) return limb.ends[nearer];
  if (!limb.is_hidden) {
    if (const Limb* thicker = thicker_about(limb, at)) return own_vertex(*thicker, nearest_in(*thicker, at));
    if (!is_shared_[nearest]) return nearest;
  }
  double least =
      limb.is_hidden ? std::numeric_limits<double>::infinity() : depth_below(limb, rank_[nearest], at);
  if (least < 0) return nearest;
  std::uint32_t owner = nearest;
  if (outside[nearer] < least) {
    least = outside[nearer];
    owner = limb.ends[nearer];
  }
  any_beside(limb, [&](const Limb& other) {
    if (is_handle_of(other, limb) || std::sqrt(other.box.squared_distance(at)) >= least) return false;
    const std::size_t n = nearest_in(other, at);
    const double depth = depth_below(other, n, at);
    if (depth < least) {
      least = depth;
      owner = own_vertex(other, n);
    }
    return false;
  });
  return owner;
}

}  // namespace affskel::core
