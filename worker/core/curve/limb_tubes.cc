#include "core/curve/limb_tubes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/none.h"

namespace affskel::core {
namespace {

// A limb among others.
struct TubeAmongOthers : TubedLimb {
  std::array<std::vector<std::uint32_t>, 2> thicker = {},
                                            others = {};  // that meet it there, the thickest first
  bool is_hidden = false;                                 // in the tubes of others, whole
};

constexpr double kOwnEllipses = 1.5;  // a limb has, of what is nearest to it, where a hub would have it

class LimbTubes {
 public:
  explicit LimbTubes(const TubedLimbsInput& input) : places_(input.places), tubed_(tubed_limbs(input)) {
    for (TubedLimb& limb : tubed_.limbs) limbs_.push_back({std::move(limb)});
    for (Limb& limb : limbs_)
      for (std::size_t end = 0; end < 2 && !limb.vertices.empty(); ++end) compare(limb, end);
    find_hidden();
    for (const Limb& limb : limbs_)
      for (const auto& thicker : limb.thicker)
        for (const std::uint32_t other : thicker)
          for (const std::uint32_t v : limb.vertices)
            if (!tubed_.is_shared[v] && holds(limbs_[other], places_[v])) tubed_.is_shared[v] = 1;
  }

  std::uint32_t vertex_of(const Vec3& at, std::uint32_t nearest) const {
    if (const LimbHub* hub = tubed_.hubs.at(nearest)) return about_hub(hub->joint, at);
    if (tubed_.is_joint(nearest)) nearest = off_joint(nearest, at);
    if (tubed_.limb_of[nearest] == kNone) return nearest;
    if (tubed_.is_shared[nearest]) nearest = nearest_beside(nearest, at);
    const Limb& limb = limbs_[tubed_.limb_of[nearest]];
    const std::array<double, 2> outside{outside_hub(limb.ends[0], at), outside_hub(limb.ends[1], at)};
    const std::size_t nearer = outside[1] < outside[0] ? 1 : 0;
    const bool keeps = !limb.is_hidden && is_own_at_hub(limb, nearest, nearer, at);
    if (outside[nearer] < 0) return keeps ? nearest : limb.ends[nearer];
    if (!limb.is_hidden) {
      if (const Limb* thicker = thicker_about(limb, at))
        return own_vertex(*thicker, nearest_in(*thicker, at));
      if (!tubed_.is_shared[nearest]) return nearest;
    }
    double least = limb.is_hidden ? std::numeric_limits<double>::infinity()
                                  : depth_below(limb, tubed_.rank[nearest], at);
    if (least < 0) return nearest;
    std::uint32_t owner = nearest;
    if (outside[nearer] < least && !keeps) {
      least = outside[nearer];
      owner = limb.ends[nearer];
    }
    any_beside(limb, [&](const Limb& other) {
      if (is_handle_of(other, limb) || std::sqrt(other.box.squared_distance(at)) >= least) return false;
      const std::size_t n = nearest_in(other, at);
      const double depth = depth_below(other, n, at);
      if (depth < least && may_take(other, n, limb)) {
        least = depth;
        owner = own_vertex(other, n);
      }
      return false;
    });
    return owner;
  }

 private:
  using Limb = TubeAmongOthers;

  // The limbs that meet one at an end, the thickest first.
  void compare(Limb& limb, std::size_t end) const {
    std::vector<std::uint32_t> round = tubed_.at_joint[limb.ends[end]];
    std::stable_sort(round.begin(), round.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return limbs_[a].size > limbs_[b].size; });
    for (const std::uint32_t other : round) {
      if (&limbs_[other] == &limb) continue;
      const bool is_thicker = limbs_[other].size > kClearlyThicker * limb.size;
      (is_thicker ? limb.thicker : limb.others)[end].push_back(other);
    }
    // Only the thickest goes on beyond its joint, and a hub is: a limb begins between two vertices.
    const bool at_hub = tubed_.hubs.at(limb.ends[end]) != nullptr;
    if (at_hub || !limb.thicker[end].empty())
      limb.rings[limb.index(end, 0)].thickness =
          (at_hub ? 1 : 0.5) * norm(places_[limb.at(end, 1)] - places_[limb.at(end, 0)]);
  }

  // Links and loops whose lines lie in the tubes of those that they meet, shorter ones first.
  void find_hidden() {
    std::vector<std::uint32_t> order;
    for (std::uint32_t n = 0; n < limbs_.size(); ++n)
      if (!limbs_[n].vertices.empty() && tubed_.is_joint(limbs_[n].ends[0]) &&
          tubed_.is_joint(limbs_[n].ends[1]))
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
  bool any_beside(const Limb& limb, const Fulfils& fulfils) const {
    for (const auto* rounds : {&limb.thicker, &limb.others})
      for (const auto& round : *rounds)
        for (const std::uint32_t other : round)
          if (!limbs_[other].is_hidden && fulfils(limbs_[other])) return true;
    return false;
  }

  // How far a place is outside the tube at one of its vertices, along the way from there; within it less than 0.
  double depth_below(const Limb& limb, std::size_t n, const Vec3& at) const {
    const TubeRing& ring = limb.rings[n];
    const Vec3 way = at - places_[limb.vertices[n]];
    const double square = dot(way, way), u = dot(way, ring.u), v = dot(way, ring.v);
    if (!(square > 0)) return -ring.thickness;
    const double along = std::max(0.0, square - u * u - v * v) / (ring.thickness * ring.thickness);
    return std::sqrt(square) * (1 - 1 / std::sqrt(ring.across(way) + along));
  }

  std::size_t nearest_in(const Limb& limb, const Vec3& at) const {
    double least = std::numeric_limits<double>::infinity();
    std::size_t nearest = 0;
    for (std::size_t n = 0; n < limb.vertices.size(); ++n) {
      const double here = squared_distance(at, places_[limb.vertices[n]]);
      if (here >= least) continue;
      least = here;
      nearest = n;
    }
    return nearest;
  }

  // Of a joint the vertex beside it, the joint where that is one, too.
  std::uint32_t own_vertex(const Limb& limb, std::size_t n) const {
    const std::size_t last = limb.vertices.size() - 1;
    if (tubed_.is_joint(limb.vertices[n])) n = n == 0 ? 1 : last - 1;
    return limb.vertices[n];
  }

  bool holds(const Limb& limb, const Vec3& at) const {
    return limb.box.squared_distance(at) <= 0 && depth_below(limb, nearest_in(limb, at), at) < 0;
  }

  // A joint's next vertex, the nearest that is none; the joint where there is none.
  std::uint32_t off_joint(std::uint32_t vertex, const Vec3& at) const {
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t nearest = vertex;
    for (const std::uint32_t n : tubed_.at_joint[vertex]) {
      for (std::size_t end = 0; end < 2; ++end) {
        const std::uint32_t next = limbs_[n].at(end, 1);
        const double way = norm(at - places_[next]);
        if (limbs_[n].ends[end] != vertex || tubed_.is_joint(next) || way >= least) continue;
        least = way;
        nearest = next;
      }
    }
    return nearest;
  }

  double outside_hub(std::uint32_t joint, const Vec3& at) const {
    const LimbHub* hub = tubed_.hubs.at(joint);
    return hub ? hub->outside(at) : std::numeric_limits<double>::infinity();
  }

  // What a limb that begins within the ellipsoid of a hub has within it and beside it, as a finger where it leaves the palm, with
  // what noise makes stand out; it has a flat end.
  bool is_own_at_hub(const Limb& limb, std::uint32_t vertex, std::size_t end, const Vec3& at) const {
    const std::uint32_t first = limb.at(end, 0);
    if (outside_hub(limb.ends[end], places_[first]) >= 0) return false;
    const TubeRing& ring = limb.rings[tubed_.rank[vertex]];
    const Vec3 way = at - places_[vertex];
    if (vertex == first && (end == 0 ? -1 : 1) * dot(cross(ring.u, ring.v), way) > 0) return false;
    return ring.across(way) < kOwnEllipses * kOwnEllipses;
  }

  // What is nearest to a hub's own lines, or to its limbs' within it.
  std::uint32_t about_hub(std::uint32_t joint, const Vec3& at) const {
    double least = outside_hub(joint, at);
    std::uint32_t owner = joint;
    if (least < 0) return owner;
    for (const std::uint32_t number : tubed_.at_joint[joint]) {
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

  // Elsewhere a limb that is no thicker comes close by chance, as a hand to a hip.
  bool may_take(const Limb& limb, std::size_t n, const Limb& from) const {
    return tubed_.is_shared[limb.vertices[n]] != 0 || limb.size > kClearlyThicker * from.size;
  }

  // It has no more than what the walk along lines takes to it: noise makes some within a body's hips.
  static bool is_handle_of(const Limb& loop, const Limb& limb) {
    return loop.ends[0] == loop.ends[1] && loop.size <= limb.size;
  }

  // Of a vertex and the limbs that meet its own the nearest, which a walk along lines does not come to where it leads
  // away from a place first.
  std::uint32_t nearest_beside(std::uint32_t vertex, const Vec3& at) const {
    double least = norm(at - places_[vertex]);
    std::uint32_t nearest = vertex;
    const Limb& limb = limbs_[tubed_.limb_of[vertex]];
    any_beside(limb, [&](const Limb& other) {
      if (is_handle_of(other, limb)) return false;
      const std::size_t n = nearest_in(other, at);
      const std::uint32_t found = own_vertex(other, n);
      const double way = norm(at - places_[found]);
      if (way >= least || tubed_.limb_of[found] == kNone || !may_take(other, n, limb)) return false;
      least = way;
      nearest = found;
      return false;
    });
    return nearest;
  }

  // Of the thicker limbs that meet one, whose tubes hold a place, the thickest; of those about as thick the one that
  // it lies deepest in.
  const Limb* thicker_about(const Limb& limb, const Vec3& at) const {
    const Limb* found = nullptr;
    double thickest = 0, least = 0;
    for (const auto& round : limb.thicker)
      for (const std::uint32_t number : round) {
        const Limb& other = limbs_[number];
        if (other.is_hidden || kClearlyThicker * other.size < thickest || !holds(other, at)) continue;
        const double depth = depth_below(other, nearest_in(other, at), at);
        if (found != nullptr && other.size <= kClearlyThicker * thickest && depth >= least) continue;
        thickest = std::max(thickest, other.size);
        found = &other;
        least = depth;
      }
    return found;
  }

  std::span<const Vec3> places_;
  TubedLimbs tubed_;  // is_shared also where a vertex lies in a thicker limb's tube
  std::vector<Limb> limbs_;
};

}  // namespace

VertexOfPlace limb_tubes(const TubedLimbsInput& input) {
  return [tubes = std::make_shared<const LimbTubes>(input)](const Vec3& at, std::uint32_t nearest) {
    return tubes->vertex_of(at, nearest);
  };
}

}  // namespace affskel::core
