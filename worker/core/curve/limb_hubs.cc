#include "core/curve/limb_hubs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "core/base/median.h"
#include "core/curve/parted_lines.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/lattice/lattice_points.h"
#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

constexpr double kThick = 1.55;           // times as thick as all its limbs but the thickest
constexpr double kThicker = 1.4;          // times as thick as the thickest
constexpr double kFilled = 0.66;          // of the ellipsoid with its moments: a network fills less
constexpr double kFilledStrictly = 0.74;  // from about a body, or beside others: half of a gear fills less
constexpr double kFilledAlone = 0.85;  // with what its limbs leave it: ends of these fill the ellipsoid less
constexpr double kAbout = 2;           // times the ellipsoid of a body: what may grow, too
constexpr double kAsFilled = 0.9;      // times what those that it joins fill of theirs
constexpr double kTaken =
    1.5;  // times what has grown, with what of limbs that it would grow along lies in it
constexpr double kOfTube = 1.1;  // times a limb's own sections: where they are larger, a hub begins

class FindHubs {
 public:
  explicit FindHubs(const LimbHubsInput& input)
      : in_(input),
        ends_(ends_of(input.places.size(), input.lines)),
        is_tried_(input.places.size(), 0),
        moments_(input.places.size()),
        stop_(input.context),
        result_{{}, std::vector<std::uint32_t>(input.places.size(), kNone)} {}

  LimbHubs run() {
    each_point([&](const Vec3& at, std::uint32_t v) { moments_[v].add({1, at, outer(at, at)}); });
    parted_ = parted_lines({in_.places, in_.lines, in_.radius, moments_, in_.lattice.spacing});
    runs_out_.resize(parted_.limbs.size());
    join_what_touches();
    std::vector<std::uint32_t> bodies;
    for (std::uint32_t v = 0; v < ends_.size(); ++v)
      if (parted_.is_body[v] && parted_.bodies.find(v) == v) bodies.push_back(v);
    for (const std::uint32_t body : bodies) add_hub(body);
    std::fill(is_tried_.begin(), is_tried_.end(), 0);
    is_widened_.assign(result_.hubs.size() + bodies.size(), 0);
    for (const std::uint32_t body : bodies) add_wide_hub(body);
    number_hubs();
    return std::move(result_);
  }

 private:
  bool is_joint(std::uint32_t v) const { return ends_[v] > 2; }

  template <class Visit>
  void each_point(const Visit& visit) {
    for_each_point(in_.lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
      stop_.did(10);
      visit(in_.lattice.spacing * Vec3{double(i), double(j), double(k)}, in_.nearest[rank]);
    });
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

  // A hub as large as grows from a body, as far as no other has that.  Those that it joins are no longer there; where it is
  // none with them, it grows beside them.  What held a body, and was none, is what would grow from that.
  void add_hub(std::uint32_t body) {
    std::vector<std::uint32_t> own;
    PlaceMoments all;
    for (const std::uint32_t v : vertices_of(body)) {
      if (result_.of[v] != kNone) continue;
      own.push_back(v);
      all.add(moments_[v]);
    }
    stop_.did(2 * ends_.size());
    if (!may_grow(own)) return;
    if (!(all.count > 0) && !take_near_joints(own)) return;
    bool joins = true;
    if (!grow_hub(own, kFilled, joins) && !joins) grow_hub(own, kFilledStrictly, joins);
  }

  std::vector<std::uint32_t> vertices_of(std::uint32_t body) {
    std::vector<std::uint32_t> own;
    for (std::uint32_t v = body; v < ends_.size(); ++v)
      if (parted_.is_body[v] && parted_.bodies.find(v) == body) own.push_back(v);
    return own;
  }

  // Whether there is a joint among them, and any that nothing has held.
  bool may_grow(std::span<const std::uint32_t> own) const {
    return std::ranges::any_of(own, [&](std::uint32_t v) { return is_joint(v); }) &&
           std::ranges::any_of(own, [&](std::uint32_t v) { return is_tried_[v] == 0; });
  }

  // The same with what lies about a body, or about its hub: what is nearest to a joint may be little of a palm, and a hub
  // may have grown no further than to a part of it.
  void add_wide_hub(std::uint32_t body) {
    stop_.did(2 * ends_.size());
    std::vector<std::uint32_t> own = vertices_of(body);
    double least_filled = kFilledStrictly;
    std::vector<std::uint32_t> before = result_.of;
    const auto has_hub = std::ranges::find_if(own, [&](std::uint32_t v) { return before[v] != kNone; });
    if (has_hub != own.end()) {
      const std::uint32_t hub = before[*has_hub];
      if (is_widened_[hub] != 0) return;
      is_widened_[hub] = 1;
      least_filled = std::max(least_filled, kAsFilled * found_filled_[hub]);
      own.clear();
      for (std::uint32_t v = 0; v < ends_.size(); ++v) {
        if (before[v] != hub) continue;
        own.push_back(v);
        result_.of[v] = kNone;
      }
    }
    bool joins = true;
    if (may_grow(own) && take_about(own) && grow_hub(own, least_filled, joins))
      is_widened_[result_.hubs.size() - 1] = 1;
    else
      result_.of = std::move(before);
  }

  // Where no sample point is nearest to a joint, what lies within half of its ball stands for it: at some spacings the arms of a
  // starfish have all that lies about theirs.
  // @return whether there is any.
  bool take_near_joints(std::vector<std::uint32_t>& own) {
    std::vector<std::uint32_t> joints;
    std::ranges::copy_if(own, std::back_inserter(joints), [&](std::uint32_t v) { return is_joint(v); });
    stop_.did(ends_.size() * joints.size());
    const auto is_near = [&](std::uint32_t v) {
      return std::ranges::any_of(joints, [&](std::uint32_t joint) {
        return norm(in_.places[v] - in_.places[joint]) <= 0.5 * in_.radius[joint];
      });
    };
    const std::size_t before = own.size();
    for (std::uint32_t v = 0; v < ends_.size(); ++v)
      if (result_.of[v] == kNone && !parted_.is_body[v] && moments_[v].count > 0 && is_near(v))
        own.push_back(v);
    return own.size() > before;
  }

  // Adds to what is a body's own what lies about it.
  // @return whether that is anything, and no end of a long limb, which the body would grow along.
  bool take_about(std::vector<std::uint32_t>& own) {
    stop_.did(8 * ends_.size());
    PlaceMoments all;
    for (const std::uint32_t v : own) all.add(moments_[v]);
    if (!(all.count > 0)) return false;
    HubEllipsoid about = ellipsoid_of(all);
    about.form = (1 / (kAbout * kAbout)) * about.form;
    const std::size_t before = own.size();
    std::vector<char> is_own(ends_.size(), 0);
    for (const std::uint32_t v : own) is_own[v] = 1;
    for (std::uint32_t v = 0; v < ends_.size(); ++v) {
      if (is_own[v] != 0 || result_.of[v] != kNone || !holds(about, v)) continue;
      if (is_long_end(v, all.count)) return false;
      own.push_back(v);
    }
    return own.size() > before;
  }

  // @param joins whether it may join others; false then where it has, and was none.
  bool grow_hub(std::span<const std::uint32_t> own, double least_filled, bool& joins) {
    const std::vector<std::uint32_t> before = result_.of;
    const auto number = static_cast<std::uint32_t>(result_.hubs.size());
    std::fill(runs_out_.begin(), runs_out_.end(), 0);
    Growth growth{.number = number,
                  .joins = joins,
                  .may_be_filled_alone = least_filled == kFilled,
                  .least_filled = least_filled};
    do {
      result_.of = before;
      growth.all = {};
      for (const std::uint32_t v : own) {
        result_.of[v] = number;
        growth.all.add(moments_[v]);
      }
    } while (!grow(growth));
    const std::vector<std::uint32_t> grown = result_.of;
    if (is_hub(growth)) {
      result_.hubs.push_back({growth.hub, joint_of(number, growth.hub.centre)});
      found_filled_.push_back(growth.filled);
      return true;
    }
    joins = !growth.has_joined;
    for (std::uint32_t v = 0; v < ends_.size(); ++v)
      if (grown[v] == number && joins) is_tried_[v] = 1;
    result_.of = before;
    return false;
  }

  // The one nearest to its middle.
  std::uint32_t joint_of(std::uint32_t number, const Vec3& centre) const {
    std::uint32_t joint = kNone;
    for (std::uint32_t v = 0; v < ends_.size(); ++v) {
      if (result_.of[v] != number || !is_joint(v)) continue;
      if (joint == kNone || norm(in_.places[v] - centre) < norm(in_.places[joint] - centre)) joint = v;
    }
    return joint;
  }

  // Without those that others have joined.
  void number_hubs() {
    std::vector<std::uint32_t> anew(result_.hubs.size(), kNone);
    for (const std::uint32_t number : result_.of)
      if (number != kNone) anew[number] = 0;
    std::vector<LimbHub> hubs;
    for (std::size_t n = 0; n < anew.size(); ++n) {
      if (anew[n] == kNone) continue;
      anew[n] = static_cast<std::uint32_t>(hubs.size());
      hubs.push_back(result_.hubs[n]);
    }
    for (std::uint32_t& number : result_.of)
      if (number != kNone) number = anew[number];
    result_.hubs = std::move(hubs);
  }

  HubEllipsoid ellipsoid_of(const PlaceMoments& points) const {
    return HubEllipsoid::of(points, in_.lattice.spacing);
  }
  double radius_of(double count) const { return ball_radius(count, in_.lattice.spacing); }

  // What grows, to a hub perhaps.
  struct Growth {
    std::uint32_t number;
    bool joins;  // hubs that lie in it
    bool may_be_filled_alone;
    double least_filled;  // of its ellipsoid
    PlaceMoments all = {};
    HubEllipsoid hub = {};
    bool has_joined = false;
    double filled = 0;  // of its ellipsoid, or what its limbs leave of that one's own
  };

  // Until it holds no more.
  // @return false where it came to free ends of limbs that are longer than it is thick: it grew along these, as a palm
  // along the forearm, and grows anew without.
  bool grow(Growth& growth) {
    bool runs_out = false;
    for (bool grows = true; grows && !runs_out;) {
      growth.hub = ellipsoid_of(growth.all);
      grows = growth.joins && join(growth);
      growth.has_joined = growth.has_joined || grows;
      stop_.did(8 * ends_.size());
      for (std::uint32_t v = 0; v < ends_.size(); ++v) {
        if (result_.of[v] != kNone || !holds(growth.hub, v)) continue;
        if (parted_.limb[v] != kNone && runs_out_[parted_.limb[v]] != 0) continue;
        if (is_long_end(v, growth.all.count)) runs_out_[parted_.limb[v]] = runs_out = true;
        result_.of[v] = growth.number;
        growth.all.add(moments_[v]);
        grows = true;
      }
    }
    return !runs_out;
  }

  // The middle of what is nearest to a vertex: lines may run along the rim of a head.
  bool holds(const HubEllipsoid& hub, std::uint32_t v) const {
    return hub.outside(moments_[v].count > 0 ? moments_[v].centre() : in_.places[v]) < 0;
  }

  // Hubs that both hold the place between their middles are one where that fills its ellipsoid about as they do theirs, as
  // the halves of a body, and not a head and a trunk.
  bool join(Growth& growth) {
    bool any = false;
    for (std::uint32_t v = 0; v < ends_.size(); ++v) {
      const std::uint32_t other = result_.of[v];
      if (other == kNone || other == growth.number) continue;
      const LimbHub& found = result_.hubs[other];
      const Vec3 between = 0.5 * (growth.hub.centre + found.centre);
      if (growth.hub.outside(between) >= 0 || found.outside(between) >= 0) continue;
      growth.least_filled = std::max(growth.least_filled, kAsFilled * found_filled_[other]);
      result_.of[v] = growth.number;
      growth.all.add(moments_[v]);
      any = true;
    }
    return any;
  }

  bool is_long_end(std::uint32_t v, double count) const {
    return ends_[v] == 1 && parted_.limb[v] != kNone &&
           parted_.limbs[parted_.limb[v]].length > 2 * radius_of(count);
  }

  // The middle of a ring or of what is bent lies outside the solid.  Parts it from its limbs, too.
  bool is_hub(Growth& growth) {
    stop_.did(4 * ends_.size());
    const HubEllipsoid& hub = growth.hub;
    growth.filled = hub.filled_by(growth.all, in_.lattice.spacing);
    const bool is_filled = growth.filled >= growth.least_filled;
    return (is_filled || growth.may_be_filled_alone) && !hub.is_bar() &&
           is_sample_point(in_.lattice, (1 / in_.lattice.spacing) * hub.centre) && holds_no_limb(growth) &&
           parts_no_limb(growth) && is_thick(growth) && (is_filled || is_filled_alone(growth));
  }

  bool is_filled_alone(Growth& growth) const {
    PlaceMoments left;
    for (std::uint32_t v = 0; v < ends_.size(); ++v)
      if (result_.of[v] == growth.number) left.add(moments_[v]);
    growth.filled = ellipsoid_of(left).filled_by(left, in_.lattice.spacing);
    return growth.filled >= kFilledAlone;
  }

  // What takes the middle out of a limb leaves one in two pieces.
  bool parts_no_limb(const Growth& growth) const {
    const auto is_hubs = [&](std::uint32_t v) { return result_.of[v] == growth.number; };
    return std::none_of(parted_.limbs.begin(), parted_.limbs.end(), [&](const PartedLimb& limb) {
      return !is_hubs(limb.line.front()) && !is_hubs(limb.line.back()) &&
             std::any_of(limb.line.begin(), limb.line.end(), is_hubs);
    });
  }

  // Parts limbs at the ellipsoid, where noise moves the place where their slices begin to grow, and then by their sections.
  // @return false where one that is long lies within, whole.
  bool holds_no_limb(const Growth& growth) {
    for (std::uint32_t v = 0; v < ends_.size(); ++v) {
      const bool is_outside = growth.hub.outside(in_.places[v]) >= 0;
      if (is_outside && parted_.limb[v] != kNone && result_.of[v] == growth.number) result_.of[v] = kNone;
      if (is_outside || result_.of[v] != kNone) continue;
      if (is_long_end(v, growth.all.count)) return false;
      result_.of[v] = growth.number;
    }
    for (PartedLimb& limb : parted_.limbs)
      for (int end = 0; end < 2; ++end, std::reverse(limb.line.begin(), limb.line.end()))
        if (result_.of[limb.line[0]] == growth.number) part_by_sections(limb.line, growth.number);
    return true;
  }

  // With what its limbs leave it.  One that has much of limbs along which it did not grow is a part of these.
  bool is_thick(const Growth& growth) const {
    const auto is_hubs = [&](std::uint32_t v) { return result_.of[v] == growth.number; };
    double count = 0;
    for (std::uint32_t v = 0; v < ends_.size(); ++v)
      if (is_hubs(v)) count += moments_[v].count;
    std::array<double, 2> thickest{};
    for (const PartedLimb& limb : parted_.limbs) {
      if (!is_hubs(limb.line.front()) && !is_hubs(limb.line.back())) continue;
      if (std::all_of(limb.line.begin(), limb.line.end(), is_hubs)) continue;
      thickest[1] = std::max(thickest[1], std::min(limb.size, thickest[0]));
      thickest[0] = std::max(thickest[0], limb.size);
    }
    const double radius = radius_of(count);
    return count < kTaken * growth.all.count && thickest[0] > 0 && radius > kThicker * thickest[0] &&
           radius > kThick * thickest[1];
  }

  // Of a line from a hub on, what has sections as beyond is a limb's, and where these grow suddenly it is the hub's, over as
  // much as the limb is thick.
  void part_by_sections(const std::vector<std::uint32_t>& line, std::uint32_t number) {
    const std::size_t last =
        is_joint(line.back()) ? line.size() / 2 : line.size();  // beyond, a link leads to another
    std::size_t first = 0;
    while (first < last && result_.of[line[first]] == number) ++first;
    std::vector<double> sections;
    for (std::size_t n = first; n < last && result_.of[line[n]] == kNone; ++n)
      sections.push_back(in_.section[line[n]]);
    if (sections.empty()) return;
    const double own = median(std::move(sections)),
                 begin = length_of(in_.places, std::span(line).first(first + 1));
    const auto is_near = [&] {
      return length_of(in_.places, std::span(line).first(first + 1)) - begin < own;
    };
    while (first < line.size() / 2 && result_.of[line[first]] == kNone && is_near() &&
           grows_at(in_.places, line, first, in_.section))
      result_.of[line[first++]] = number;
    while (first > 1 && in_.section[line[first - 1]] <= kOfTube * own) result_.of[line[--first]] = kNone;
  }

  const LimbHubsInput& in_;
  std::vector<std::uint32_t> ends_;    // of lines, per vertex
  std::vector<char> is_tried_;         // per vertex: held by what has grown, and was no hub
  std::vector<char> is_widened_;       // per hub: it has grown, or not, from what lies about it
  std::vector<PlaceMoments> moments_;  // per vertex: of its points
  PartedLines parted_;
  std::vector<char> runs_out_;  // per limb: a hub would grow along it to its end
  StopCheck stop_;
  std::vector<double> found_filled_;  // per hub
  LimbHubs result_;
};

}  // namespace

LimbHubs limb_hubs(const LimbHubsInput& input) {
  return FindHubs(input).run();
}

}  // namespace affskel::core
