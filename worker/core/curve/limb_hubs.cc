#include "core/curve/limb_hubs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/base/disjoint_sets.h"
#include "core/base/median.h"
#include "core/base/symmetric_eigen.h"
#include "core/lattice/lattice_points.h"
#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

constexpr double kSudden = 0.4;   // of the way along a line: what a limb's radius grows by where it ends
constexpr double kThick = 1.55;   // times as thick as all its limbs but the thickest
constexpr double kThicker = 1.4;  // times as thick as the thickest
constexpr double kGrown = 1.1;    // times the ellipsoid: what lies just outside is no limb's
constexpr double kFilled = 0.45;  // of the ellipsoid with its moments: a network fills less
constexpr double kPlate = 2;      // times as wide as thick: what is nearest to a line makes no tube
constexpr double kBar = 3.5;      // times as long as wide: a limb, which grows where it turns a corner

// Of places, each as much.
struct HubMoments {
  double count = 0;
  Vec3 first;
  Matrix3 second{};

  void add(const HubMoments& other) {
    count += other.count;
    first = first + other.first;
    second = second + other.second;
  }
  Vec3 centre() const { return (1 / count) * first; }
  Matrix3 about_centre() const { return second + -1.0 * outer(first, centre()); }
};

struct HubLimb {
  std::array<std::uint32_t, 2> ends;
  double size;
};

class FindHubs {
 public:
  explicit FindHubs(const LimbHubsInput& input)
      : in_(input),
        ends_(ends_of(input.places.size(), input.lines)),
        length_(input.places.size(), 0),
        is_body_(input.places.size(), 0),
        bodies_(input.places.size()),
        moments_(input.places.size()),
        result_{{}, std::vector<std::uint32_t>(input.places.size(), kNone)} {}

  LimbHubs run() {
    StopCheck stop(in_.context);
    each_point(stop, [&](const Vec3& at, std::uint32_t v) { moments_[v].add({1, at, outer(at, at)}); });
    for (const auto& line : in_.lines) part(line);
    join_what_touches(stop);
    for (std::uint32_t v = 0; v < ends_.size(); ++v)
      if (is_body_[v] && bodies_.find(v) == v) add_hub(v);
    return std::move(result_);
  }

 private:
  bool is_joint(std::uint32_t v) const { return ends_[v] > 2; }
  double way(std::uint32_t a, std::uint32_t b) const { return norm(in_.places[a] - in_.places[b]); }

  // How thick a line is in the middle of its vertices.
  double size_of(const std::vector<std::uint32_t>& line) const {
    std::vector<double> radii;
    for (const std::uint32_t v : line)
      if (!is_joint(v)) radii.push_back(in_.radius[v]);
    return radii.empty() ? 0 : median(std::move(radii));
  }

  // How much wider than thick what is nearest to a line is, across it: in its slices, which are thinner.
  double flatness(const std::vector<std::uint32_t>& line) const {
    Matrix3 across{};
    double count = 0;
    for (const std::uint32_t v : line) {
      if (is_joint(v) || moments_[v].count == 0) continue;
      across = across + moments_[v].about_centre();
      count += moments_[v].count;
    }
    const auto spread = symmetric_eigen(across + count * cell() * kIdentity3).values;
    return count > 0 ? std::sqrt(spread[0] / spread[1]) : 1;
  }

  // How many of a line's first vertices are no limb's; from its middle on, by what it grows over a radius.
  std::size_t before_limb(const std::vector<std::uint32_t>& line) const {
    for (std::size_t n = line.size() / 2; n > 1; --n) {
      double length = 0;
      std::size_t k = n - 1;
      for (; k < line.size() / 2 && length < in_.radius[line[k]]; ++k) length += way(line[k], line[k + 1]);
      if (in_.radius[line[n - 1]] - in_.radius[line[k]] > kSudden * length) return n;
    }
    return 1;
  }

  // What of a line is a limb's, and what is not.
  void part(std::vector<std::uint32_t> line) {
    const std::uint32_t a = line.front(), b = line.back();
    const double length = length_of(in_.places, line);
    const double size = size_of(line);
    const bool is_link = is_joint(a) && is_joint(b);
    if (is_link && (length < 2 * size || (a != b && flatness(line) > kPlate)))
      return give_body(line, line.size());
    for (const std::uint32_t v : line)
      if (!is_joint(v)) length_[v] = length;
    limbs_.push_back({{a, b}, size});
    for (int end = 0; end < 2; ++end, std::reverse(line.begin(), line.end()))
      if (is_joint(line[0])) give_body(line, before_limb(line));
  }

  void give_body(const std::vector<std::uint32_t>& line, std::size_t count) {
    for (std::size_t n = 0; n < count; ++n) {
      is_body_[line[n]] = 1;
      bodies_.unite(line[n], line[0]);
    }
  }

  double cell() const { return in_.lattice.spacing * in_.lattice.spacing / 12; }

  template <class Visit>
  void each_point(StopCheck& stop, const Visit& visit) const {
    for_each_point(in_.lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
      stop.did(10);
      visit(in_.lattice.spacing * Vec3{double(i), double(j), double(k)}, in_.nearest[rank]);
    });
  }

  // Bodies of points that follow each other in a row.
  void join_what_touches(StopCheck& stop) {
    Vec3 last;
    std::uint32_t before = kNone;
    each_point(stop, [&](const Vec3& at, std::uint32_t v) {
      const bool is_next = before != kNone && norm(at - last) < 1.1 * in_.lattice.spacing;
      if (is_next && is_body_[v] && is_body_[before]) bodies_.unite(v, before);
      before = v;
      last = at;
    });
  }

  void add_hub(std::uint32_t body) {
    const auto number = static_cast<std::uint32_t>(result_.hubs.size());
    LimbHub hub{kNone, {}};
    HubMoments all;
    std::vector<std::uint32_t> own;
    for (std::uint32_t v = body; v < ends_.size(); ++v) {
      if (!is_body_[v] || bodies_.find(v) != body || result_.of[v] != kNone) continue;
      own.push_back(v);
      all.add(moments_[v]);
      if (is_joint(v) && (hub.joint == kNone || in_.radius[v] > in_.radius[hub.joint])) hub.joint = v;
    }
    if (hub.joint == kNone || !is_thick(body, all.count)) return;
    for (const std::uint32_t v : own) result_.of[v] = number;
    if (grow(number, all, hub))
      result_.hubs.push_back(hub);
    else
      std::replace(result_.of.begin(), result_.of.end(), number, kNone);
  }

  bool is_thick(std::uint32_t body, double count) {
    std::array<double, 2> thickest{};
    for (const HubLimb& limb : limbs_) {
      if (bodies_.find(limb.ends[0]) != body && bodies_.find(limb.ends[1]) != body) continue;
      thickest[1] = std::max(thickest[1], std::min(limb.size, thickest[0]));
      thickest[0] = std::max(thickest[0], limb.size);
    }
    const double radius = radius_of(count);
    return thickest[0] > 0 && radius > kThicker * thickest[0] && radius > kThick * thickest[1];
  }

  double radius_of(double count) const {  // of a ball
    return in_.lattice.spacing * std::cbrt(0.75 / std::numbers::pi * count);
  }

  // Until it holds no more; false where it holds a free end of a limb that is longer than it is thick.  What of
  // limbs lies outside in the end is theirs: where their slices begin to grow, noise changes.
  bool grow(std::uint32_t number, HubMoments& all, LimbHub& hub) {
    for (bool grows = true; grows;) {
      grows = false;
      fit(all, hub);
      for (std::uint32_t v = 0; v < ends_.size(); ++v) {
        if (result_.of[v] != kNone || hub.outside(in_.places[v]) >= 0) continue;
        if (ends_[v] == 1 && length_[v] > 2 * radius_of(all.count)) return false;
        result_.of[v] = number;
        all.add(moments_[v]);
        grows = true;
      }
    }
    for (std::uint32_t v = 0; v < ends_.size(); ++v)
      if (result_.of[v] == number && length_[v] > 0 && hub.outside(in_.places[v]) >= 0) result_.of[v] = kNone;
    return fills(all.count, hub) && !is_bar(hub) && has_middle(hub);
  }

  // A network of rods is none.
  bool fills(double count, const LimbHub& hub) const {
    const double ball = std::pow(radius_of(count) * kGrown, 3);
    return ball * std::sqrt(determinant(hub.form)) >= kFilled;
  }

  // The middle of a ring or of what is bent lies outside the solid.
  bool has_middle(const LimbHub& hub) const {
    std::array<std::int64_t, 3> place{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      place[axis] = std::llround(hub.centre[axis] / in_.lattice.spacing);
    const auto& runs = in_.lattice.axis[2].runs;
    const auto is_before = [](const std::array<std::int64_t, 3>& at, const LatticeRun& run) {
      return std::lexicographical_compare(at.begin(), at.end(), run.start.begin(), run.start.end());
    };
    const auto after = std::upper_bound(runs.begin(), runs.end(), place, is_before);
    if (after == runs.begin()) return false;
    const LatticeRun& run = *std::prev(after);
    return run.start[0] == place[0] && run.start[1] == place[1] &&
           place[2] < std::int64_t{run.start[2]} + run.length;
  }

  bool is_bar(const LimbHub& hub) const {
    const auto steep = symmetric_eigen(hub.form).values;  // one over the squares of the axes
    return steep[1] > kBar * kBar * steep[2];
  }

  // The mean square of a place in a ball, along an axis, is a fifth of the radius', in a cube a twelfth of the edge's.
  void fit(const HubMoments& all, LimbHub& hub) const {
    hub.centre = all.centre();
    const Matrix3 spread = (1 / all.count) * all.about_centre() + cell() * kIdentity3;
    hub.form = (1 / (5 * kGrown * kGrown)) * inverse_transposed(spread);
  }

  const LimbHubsInput& in_;
  std::vector<std::uint32_t> ends_;  // of lines, per vertex
  std::vector<double> length_;       // per vertex: of the limb that its line is; 0 of a joint
  std::vector<char> is_body_;        // per vertex: no limb's
  DisjointSets bodies_;
  std::vector<HubLimb> limbs_;
  std::vector<HubMoments> moments_;  // per vertex: of its points
  LimbHubs result_;
};

}  // namespace

// By how it grows there: along the way from the centre the rim of a flat body would be far away.
double LimbHub::outside(const Vec3& at) const {
  const Vec3 way = at - centre, steep = form * way;
  const double square = dot(way, steep);
  if (!(square > 0)) return -std::numeric_limits<double>::infinity();
  return (square - std::sqrt(square)) / norm(steep);
}

LimbHubs limb_hubs(const LimbHubsInput& input) {
  return FindHubs(input).run();
}

}  // namespace affskel::core
