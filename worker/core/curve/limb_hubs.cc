#include "core/curve/limb_hubs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include "core/base/median.h"
#include "core/curve/parted_lines.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/lattice/lattice_points.h"
#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

constexpr double kThick = 1.55;   // times as thick as all its limbs but the thickest
constexpr double kThicker = 1.4;  // times as thick as the thickest
constexpr double kAcross = 1.3;   // times the thickest, its second axis: of a stretch of a tube 1.23
constexpr double kLack = 2;       // of what a hub has, for each that its ellipsoid lacks
constexpr double kTaken = 1.2;    // times what lies in its ellipsoid, with all that its limbs leave it
// Of a limb that is longer than a hub is thick, what this leaves at least, unless it is so many times as thick.
constexpr double kLeft = 1. / 3, kFarThicker = 2.5;
// Of a hub's thickness: shorter limbs are spurs in it.  What one that has a longer one whole counts, of its worth: another is
// looked for.
constexpr double kStub = 0.5, kWithStub = 0.1;
constexpr double kOfTube = 1.1;  // times a limb's own sections: where they are larger, a hub begins
constexpr double kTaper = 0.1;  // of a way towards a hub: what a limb's sections grow by at most, as a cone's
constexpr double kResolved = 1.5;     // spacings: less of an axis tells no shape
constexpr double kScales[] = {1, 2};  // of the ellipsoid of a body, to begin with
constexpr int kSteps = 100;           // bodies settle in 1 to 54

class FindHubs {
 public:
  explicit FindHubs(const LimbHubsInput& input)
      : in_(input),
        ends_(ends_of(input.places.size(), input.lines)),
        tip_of_(input.places.size(), 0),
        moments_(input.places.size()),
        stop_(input.context) {}

  LimbHubs run() {
    each_point([&](const Vec3& at, std::uint32_t v) { moments_[v].add({1, at, outer(at, at)}); });
    parted_ = parted_lines({in_.places, in_.lines, in_.radius, moments_, in_.lattice.spacing});
    for (const PlaceMoments& all : moments_) middle_.push_back(all.count > 0 ? all.centre() : Vec3{});
    find_tips();
    join_what_touches();
    for (std::uint32_t v = 0; v < ends_.size(); ++v)
      if (parted_.is_body[v] && parted_.bodies.find(v) == v) start_from(v);
    return chosen();
  }

 private:
  struct Candidate {
    HubEllipsoid form;
    PlaceMoments within;         // what has settled
    std::vector<char> has = {};  // per vertex
    double worth = 0;            // points, less kLack of what its ellipsoid lacks
    bool has_stub = false;       // the whole of a limb that is about as long as it is thick
  };

  bool is_joint(std::uint32_t v) const { return ends_[v] > 2; }
  double diameter_of(double count) const { return 2 * ball_radius(count, in_.lattice.spacing); }
  HubEllipsoid ellipsoid_of(const PlaceMoments& points) const {
    return HubEllipsoid::of(points, in_.lattice.spacing);
  }

  template <class Visit>
  void each_point(const Visit& visit) {
    for_each_point(in_.lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
      stop_.did(10);
      visit(in_.lattice.spacing * Vec3{double(i), double(j), double(k)}, in_.nearest[rank]);
    });
  }

  PlaceMoments moments_of(const std::vector<char>& has) {
    stop_.did(2 * has.size());
    PlaceMoments all;
    for (std::size_t v = 0; v < has.size(); ++v)
      if (has[v] != 0) all.add(moments_[v]);
    return all;
  }

  // Of limbs that end free, their outer halves.
  void find_tips() {
    for (PartedLimb& limb : parted_.limbs)
      for (int end = 0; end < 2; ++end, std::reverse(limb.line.begin(), limb.line.end()))
        for (std::size_t n = 0; ends_[limb.line[0]] == 1 && 2 * n < limb.line.size(); ++n)
          tip_of_[limb.line[n]] = limb.length;
  }

  // Bodies of points that follow each other in a row.
  void join_what_touches() {
    Vec3 last;
    std::uint32_t before = kNone;
    each_point([&](const Vec3& at, std::uint32_t v) {
      const bool is_next = before != kNone && norm(at - last) < 1.1 * in_.lattice.spacing;
      if (is_next && parted_.is_body[v] && parted_.is_body[before]) parted_.bodies.unite(v, before);
      before = v;
      last = at;
    });
  }

  // With what lies within half of the radii of its joints: at some spacings the arms of a starfish have all that lies about
  // theirs.
  void start_from(std::uint32_t body) {
    std::vector<char> has(ends_.size(), 0);
    std::vector<std::uint32_t> joints;
    for (std::uint32_t v = body; v < ends_.size(); ++v) {
      has[v] = parted_.is_body[v] && parted_.bodies.find(v) == body;
      if (has[v] != 0 && is_joint(v)) joints.push_back(v);
    }
    stop_.did(ends_.size() * joints.size());
    for (std::uint32_t v = 0; v < ends_.size(); ++v)
      if (std::ranges::any_of(joints, [&](std::uint32_t joint) {
            return norm(in_.places[v] - in_.places[joint]) <= 0.5 * in_.radius[joint];
          }))
        has[v] = 1;
    const PlaceMoments all = moments_of(has);
    if (!(all.count > 0)) return;
    const std::size_t before = found_.size();
    for (const double scale : kScales) {
      Candidate begin{ellipsoid_of(all), all};
      begin.form.form = (1 / (scale * scale)) * begin.form.form;
      add_from(begin, HUGE_VAL);
      add_from(begin, 1);
      if (std::any_of(found_.begin() + static_cast<std::ptrdiff_t>(before), found_.end(),
                      [](const Candidate& found) { return found.has_stub; }))
        add_from(begin, kStub);
    }
  }

  void add_from(Candidate found, double longest) {
    if (settle(found, longest) && is_hub(found)) found_.push_back(std::move(found));
  }

  // Takes what lies in the ellipsoid, and so on, until that stays.  Of a vertex the middle of what is nearest to it tells:
  // lines may run along the rim of a head.
  // @param longest the tips of limbs that are longer than so many times as it is thick, along which it might run, are left out.
  // @return false where it comes to nothing, or does not stay.
  bool settle(Candidate& found, double longest) {
    for (int step = 0; step < kSteps; ++step) {
      stop_.did(8 * ends_.size());
      const double thick = diameter_of(found.within.count);
      std::vector<char> has(ends_.size());
      for (std::uint32_t v = 0; v < ends_.size(); ++v) {
        has[v] = moments_[v].count > 0 && found.form.holds(middle_[v]) && tip_of_[v] <= longest * thick;
      }
      if (has == found.has) return true;
      found.within = moments_of(has);
      found.has = std::move(has);
      if (!(found.within.count > 0)) return false;
      found.form = ellipsoid_of(found.within);
    }
    return false;
  }

  // By what its limbs leave it.  The middle of a ring or of what is bent lies outside the solid.
  bool is_hub(Candidate& found) {
    if (!part_at_ellipsoid(found)) return false;
    for (PartedLimb& limb : parted_.limbs)
      for (int end = 0; end < 2; ++end, std::reverse(limb.line.begin(), limb.line.end()))
        if (found.has[limb.line[0]] != 0) part_by_sections(limb.line, found.has);
    const PlaceMoments left = moments_of(found.has);
    if (!(left.count > 0) || left.count > kTaken * found.within.count) return false;
    const HubEllipsoid form = ellipsoid_of(left);
    const auto axes = form.half_axes();
    if (!is_thick(found, axes, left.count) || form.is_bar() || axes[0] < kResolved * in_.lattice.spacing ||
        !is_sample_point(in_.lattice, (1 / in_.lattice.spacing) * form.centre))
      return false;
    const double filled = form.filled_by(left, in_.lattice.spacing);
    found.worth = left.count * (1 - kLack * (1 / filled - 1));
    return found.worth > 0 && leaves_limbs(found, diameter_of(left.count));
  }

  // Noise moves the place where slices of limbs begin to grow, and their ellipsoid little.
  // @return false where the middle of a limb alone lies within.
  bool part_at_ellipsoid(Candidate& found) {
    stop_.did(8 * ends_.size());
    for (std::uint32_t v = 0; v < ends_.size(); ++v) {
      if (found.form.holds(in_.places[v]))
        found.has[v] = 1;
      else if (parted_.limb[v] != kNone)
        found.has[v] = 0;
    }
    const auto has = [&](std::uint32_t v) { return found.has[v] != 0; };
    return std::ranges::none_of(parted_.limbs, [&](const PartedLimb& limb) {
      return !has(limb.line.front()) && !has(limb.line.back()) && std::ranges::any_of(limb.line, has);
    });
  }

  // Of a line from a hub on, what has sections as beyond, or as they taper there, is a limb's, and where these grow suddenly
  // it is the hub's, over as much as the limb is thick.
  void part_by_sections(const std::vector<std::uint32_t>& line, std::vector<char>& has) const {
    const std::size_t last =
        is_joint(line.back()) ? line.size() / 2 : line.size();  // beyond, a link leads to another
    std::size_t first = 0;
    while (first < last && has[line[first]] != 0) ++first;
    std::size_t end = first;
    while (end < last && has[line[end]] == 0) ++end;
    if (end == first) return;
    const Taper own = taper_of(std::span(line).subspan(first, end - first));
    double beyond = 0;  // of the ellipsoid
    for (; first < line.size() / 2 && has[line[first]] == 0 && beyond < own.radius &&
           grows_at(in_.places, line, first, in_.section);
         ++first) {
      has[line[first]] = 1;
      beyond += norm(in_.places[line[first]] - in_.places[line[first + 1]]);
    }
    for (double way = own.way - beyond; first > 1; has[line[--first]] = 0) {
      way += norm(in_.places[line[first]] - in_.places[line[first - 1]]);
      if (in_.section[line[first - 1]] > kOfTube * (own.radius + own.slope * way)) return;
    }
  }

  // Whether enough is left of long limbs that end free, from their ends on.  An elephant's torso has most of its legs, but what of
  // a spanner has most of a prong is its prongs.  Tells whether one has the whole of a shorter one, as a palm of its wrist.
  // @param thick how thick the hub is.
  bool leaves_limbs(Candidate& found, double thick) const {
    const double within = diameter_of(found.within.count);
    for (const PartedLimb& limb : parted_.limbs) {
      if (limb.length <= kStub * within) continue;
      const bool is_long = limb.length > within;
      const double least = is_long && thick < 2 * kFarThicker * limb.size ? kLeft * limb.length : 0;
      for (const bool from_last : {false, true}) {
        const auto at = [&](std::size_t n) { return point_from(from_last, limb.line, n); };
        const auto is_left = [&](std::size_t n) { return n < limb.line.size() && found.has[at(n)] == 0; };
        if (ends_[at(0)] != 1) continue;
        double left = 0;
        for (std::size_t n = 1; is_left(n - 1) && is_left(n); ++n)
          left += norm(in_.places[at(n)] - in_.places[at(n - 1)]);
        if (is_long && (left == 0 || left < least)) return false;
        found.has_stub = found.has_stub || left == 0;
      }
    }
    return true;
  }

  // A limb's sections: their median, and how they grow towards its hub, by those of its halves.
  struct Taper {
    double radius;
    double way;  // from the limb's end at the hub to where it is as thick
    double slope;
  };
  Taper taper_of(std::span<const std::uint32_t> limb) const {
    const auto median_of = [&](std::span<const std::uint32_t> some) {
      std::vector<double> sections;
      for (const std::uint32_t v : some) sections.push_back(in_.section[v]);
      return median(std::move(sections));
    };
    const double length = length_of(in_.places, limb);
    if (limb.size() < 6 || !(length > 0)) return {median_of(limb), length / 2, 0};
    const double growth = median_of(limb.first(limb.size() / 2)) - median_of(limb.last(limb.size() / 2));
    return {median_of(limb), length / 2, std::clamp(growth / (length / 2), 0.0, kTaper)};
  }

  // By its volume and across: that of a limb that ends near a branch is as great as a thicker ball's.
  bool is_thick(const Candidate& found, const std::array<double, 3>& axes, double count) const {
    std::vector<double> sizes;
    const auto has = [&](std::uint32_t v) { return found.has[v] != 0; };
    for (const PartedLimb& limb : parted_.limbs)
      if ((has(limb.line.front()) || has(limb.line.back())) && !std::ranges::all_of(limb.line, has))
        sizes.push_back(limb.size);
    std::ranges::sort(sizes, std::greater<>());
    const double radius = diameter_of(count) / 2;
    return !sizes.empty() && radius > kThicker * sizes[0] && axes[1] > kAcross * sizes[0] &&
           (sizes.size() < 2 || radius > kThick * sizes[1]);
  }

  // Of those in one place, where the middle of one lies in the other, that of most worth.
  LimbHubs chosen() {
    std::ranges::stable_sort(found_, std::greater<>(), [](const Candidate& found) {
      return found.has_stub ? kWithStub * found.worth : found.worth;
    });
    LimbHubs chosen{{}, std::vector<std::uint32_t>(ends_.size(), kNone)};
    for (const Candidate& found : found_) {
      stop_.did(2 * ends_.size());
      const std::uint32_t joint = joint_of(found);
      const bool is_there = std::ranges::any_of(chosen.hubs, [&](const LimbHub& hub) {
        return hub.holds(found.form.centre) || found.form.holds(hub.centre);
      });
      if (is_there || joint == kNone || chosen.of[joint] != kNone) continue;
      for (std::uint32_t v = 0; v < ends_.size(); ++v)
        if (found.has[v] != 0 && chosen.of[v] == kNone)
          chosen.of[v] = static_cast<std::uint32_t>(chosen.hubs.size());
      chosen.hubs.push_back({found.form, joint});
    }
    return chosen;
  }

  // The one nearest to its middle.
  std::uint32_t joint_of(const Candidate& found) const {
    std::uint32_t joint = kNone;
    const auto off = [&](std::uint32_t v) { return norm(in_.places[v] - found.form.centre); };
    for (std::uint32_t v = 0; v < ends_.size(); ++v)
      if (found.has[v] != 0 && is_joint(v) && (joint == kNone || off(v) < off(joint))) joint = v;
    return joint;
  }

  const LimbHubsInput& in_;
  std::vector<std::uint32_t> ends_;    // of lines, per vertex
  std::vector<double> tip_of_;         // per vertex: length of the limb that it is in the free half of, or 0
  std::vector<PlaceMoments> moments_;  // per vertex: of its points
  std::vector<Vec3> middle_;           // of these
  PartedLines parted_;
  StopCheck stop_;
  std::vector<Candidate> found_;
};

}  // namespace

LimbHubs limb_hubs(const LimbHubsInput& input) {
  return FindHubs(input).run();
}

}  // namespace affskel::core
