#include "core/curve/limb_hubs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <numbers>

#include "core/base/disjoint_sets.h"
#include "core/ridge/row_band.h"

namespace affskel::core {
namespace {

constexpr double kSudden = 0.4;  // of the way along a line: what a limb's radius grows by where it ends
constexpr double kThick = 1.55;  // times as thick as the limbs
constexpr double kGrown = 1.1;   // times the ellipsoid: what lies just outside is no limb's

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
};

struct HubLimb {
  std::array<std::uint32_t, 2> ends;
  double size;
};

class FindHubs {
 public:
  explicit FindHubs(const LimbHubsInput& input)
      : in_(input),
        ends_(input.places.size(), 0),
        is_body_(input.places.size(), 0),
        bodies_(input.places.size()),
        moments_(input.places.size()),
        result_{{}, std::vector<std::uint32_t>(input.places.size(), kNoHub)} {}

  LimbHubs run() {
    for (const auto& line : in_.lines)
      for (const std::uint32_t v : {line.front(), line.back()}) ++ends_[v];
    for (const auto& line : in_.lines) part(line);
    visit_points();
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
    if (radii.empty()) return 0;
    const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::nth_element(radii.begin(), middle, radii.end());
    return *middle;
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
    double length = 0;
    for (std::size_t n = 1; n < line.size(); ++n) length += way(line[n - 1], line[n]);
    const double size = size_of(line);
    if (a != b && is_joint(a) && is_joint(b) && length < 2 * size) return give_body(line, line.size());
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

  // What each vertex has, and which bodies touch: points that follow each other in a row.
  void visit_points() {
    StopCheck stop(in_.context);
    std::array<std::int32_t, 3> last{};
    std::uint32_t before = kNoHub;
    for_each_point(in_.lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
      stop.did(10);
      const std::uint32_t v = in_.nearest[rank];
      const Vec3 at = in_.lattice.spacing * Vec3{double(i), double(j), double(k)};
      moments_[v].add({1, at, {at.x * at, at.y * at, at.z * at}});
      const bool is_next =
          before != kNoHub && std::abs(i - last[0]) + std::abs(j - last[1]) + std::abs(k - last[2]) == 1;
      if (is_next && is_body_[v] && is_body_[before]) bodies_.unite(v, before);
      before = v;
      last = {i, j, k};
    });
  }

  void add_hub(std::uint32_t body) {
    const auto number = static_cast<std::uint32_t>(result_.hubs.size());
    LimbHub hub{kNoHub, {}};
    HubMoments all;
    std::vector<std::uint32_t> own;
    for (std::uint32_t v = body; v < ends_.size(); ++v) {
      if (!is_body_[v] || bodies_.find(v) != body || result_.of[v] != kNoHub) continue;
      own.push_back(v);
      all.add(moments_[v]);
      if (is_joint(v) && (hub.joint == kNoHub || in_.radius[v] > in_.radius[hub.joint])) hub.joint = v;
    }
    if (hub.joint == kNoHub || !is_thick(body, all.count)) return;
    for (const std::uint32_t v : own) result_.of[v] = number;
    if (grow(number, all, hub))
      result_.hubs.push_back(hub);
    else
      std::replace(result_.of.begin(), result_.of.end(), number, kNoHub);
  }

  bool is_thick(std::uint32_t body, double count) {
    double thickest = 0;
    for (const HubLimb& limb : limbs_)
      for (const std::uint32_t end : limb.ends)
        if (bodies_.find(end) == body) thickest = std::max(thickest, limb.size);
    const double radius = in_.lattice.spacing * std::cbrt(0.75 / std::numbers::pi * count);
    return thickest > 0 && radius > kThick * thickest;
  }

  // Until it holds no more; false where it holds a free end.
  bool grow(std::uint32_t number, HubMoments& all, LimbHub& hub) {
    for (bool grows = true; grows;) {
      grows = false;
      fit(all, hub);
      for (std::uint32_t v = 0; v < ends_.size(); ++v) {
        if (result_.of[v] != kNoHub || hub.outside(in_.places[v]) >= 0) continue;
        if (ends_[v] == 1) return false;
        result_.of[v] = number;
        all.add(moments_[v]);
        grows = true;
      }
    }
    return true;
  }

  // The mean square of a place in a ball, along an axis, is a fifth of the radius', in a cube a twelfth of the edge's.
  void fit(const HubMoments& all, LimbHub& hub) const {
    hub.centre = (1 / all.count) * all.first;
    const Matrix3 square{hub.centre.x * hub.centre, hub.centre.y * hub.centre, hub.centre.z * hub.centre};
    const double cell = in_.lattice.spacing * in_.lattice.spacing / 12;
    const Matrix3 spread = (1 / all.count) * all.second + (-1.0 * square + cell * kIdentity3);
    hub.form = (1 / (5 * kGrown * kGrown)) * inverse_transposed(spread);
  }

  const LimbHubsInput& in_;
  std::vector<std::uint32_t> ends_;  // of lines, per vertex
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
