#include "core/curve/hub_stars.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/none.h"
#include "core/base/symmetric_eigen.h"
#include "core/base/unit.h"
#include "core/mesh/edges.h"
#include "core/solid/solid_membership.h"
#include "core/spatial/point_index.h"

namespace affskel::core {
namespace {

constexpr double kWide = 1.8;     // times the shortest axis of a plate, the second
constexpr double kLong = 2;       // times that, the longest
constexpr double kUpright = 0.5;  // the sine of how a limb leads through it
constexpr double kRoomy = 0.45;   // of the shorter of the distances to the surface at both ends of a new line

bool is_plate(const LimbHub& hub) {
  const auto steep = symmetric_eigen(hub.form).values;  // one over the squares of the axes
  return steep[0] >= kWide * kWide * steep[1] && steep[1] <= kLong * kLong * steep[2];
}

// A new line, from a limb's first vertex to the middle.
struct Arm {
  std::uint32_t from = 0;
  std::vector<Vec3> places;  // between the two
};

class HubStars {
 public:
  HubStars(const LimbSurface& surface, double spacing, LimbHubs& hubs, SheetMesh& curve)
      : surface_(surface),
        solid_(surface.mesh),
        spacing_(spacing),
        hubs_(hubs),
        curve_(curve),
        before_(curve.vertices),
        beside_(neighbours(curve.vertices.size(), curve.segments)),
        arms_(hubs.hubs.size()) {}

  std::vector<std::uint32_t> run() {
    bool any = false;
    for (std::uint32_t n = 0; n < arms_.size(); ++n) {
      if (is_plate(hubs_.hubs[n]) && is_tree(n)) arms_[n] = arms_of(n);
      any = any || !arms_[n].empty();
    }
    if (!any) return {};
    draw();
    return std::move(number_);
  }

 private:
  const Vec3& place(std::uint32_t v) const { return before_[v].position; }

  bool is_tree(std::uint32_t number) const {
    std::size_t vertices = 0, joined = 0;
    DisjointSets sets(before_.size());
    for (const std::uint32_t of : hubs_.of) vertices += of == number;
    for (const auto& [a, b] : curve_.segments) {
      if (hubs_.of[a] != number || hubs_.of[b] != number) continue;
      if (!sets.unite(a, b)) return false;
      ++joined;
    }
    return joined + 1 == vertices;
  }

  // None where it has less than three limbs, touches another hub, or one would not stay inside.
  std::vector<Arm> arms_of(std::uint32_t number) const {
    std::vector<Arm> arms;
    for (const auto& [a, b] : curve_.segments) {
      if ((hubs_.of[a] == number) == (hubs_.of[b] == number)) continue;
      const auto [within, beyond] = hubs_.of[a] == number ? std::pair(a, b) : std::pair(b, a);
      if (hubs_.of[beyond] != kNone) return {};
      const std::optional<Arm> arm = arm_from(within, beyond, hubs_.hubs[number]);
      if (!arm) return {};
      arms.push_back(*arm);
    }
    return arms.size() < 3 ? std::vector<Arm>() : arms;
  }

  // The cubic curve that leaves a limb as its line leads and comes straight to the middle, by the plane in the middle of the
  // plate where that is steep.
  std::optional<Arm> arm_from(std::uint32_t within, std::uint32_t first, const LimbHub& hub) const {
    const Vec3 &from = place(first), &to = hub.centre, way = to - from, out = inwards(within, first);
    const Vec3 flat = symmetric_eigen(hub.form).vectors[0];
    const double steep = dot(out, flat), third = norm(way) / 3;
    const bool is_upright = std::abs(steep) > kUpright;
    const Vec3 one = from + (is_upright ? std::clamp(dot(way, flat) / steep, 0.0, third) : third) * out;
    const Vec3 two = is_upright ? one : to - (1. / 3) * (to - one);
    const double room = std::min(room_at(from), room_at(to));
    if (!(room > 0)) return std::nullopt;
    Arm arm{first, {}};
    const auto count = static_cast<int>(std::ceil(norm(way) / spacing_));
    for (int n = 1; n < count; ++n) {
      const double t = static_cast<double>(n) / count, s = 1 - t;
      const Vec3 at = s * s * s * from + 3 * s * s * t * one + 3 * s * t * t * two + t * t * t * to;
      if (room_at(at) < kRoomy * room) return std::nullopt;
      arm.places.push_back(at);
    }
    return arm;
  }

  double room_at(const Vec3& at) const { return solid_.contains(at) ? surface_.distance.nearest(at) : 0; }

  // How a limb's line leads into its hub, over two radii.
  Vec3 inwards(std::uint32_t within, std::uint32_t first) const {
    const double stretch = 2 * surface_.thickness(place(first));
    std::uint32_t before = within, at = first;
    while (norm(place(at) - place(first)) < stretch && beside_[at].size() == 2) {
      const std::uint32_t next = beside_[at][0] == before ? beside_[at][1] : beside_[at][0];
      if (hubs_.of[next] != kNone) break;
      before = std::exchange(at, next);
    }
    return unit(place(first) - place(at == first ? within : at));
  }

  void draw() {
    const SheetMesh old = std::exchange(curve_, {});
    const std::vector<std::uint32_t> of = std::exchange(hubs_.of, {});
    std::vector<char> left(before_.size(), 0);
    for (std::uint32_t v = 0; v < before_.size(); ++v) left[v] = of[v] == kNone || arms_[of[v]].empty();
    number_.assign(before_.size(), kNone);
    for (std::uint32_t v = 0; v < before_.size(); ++v)
      if (left[v]) number_[v] = add(before_[v], before_[v].position, old.part[v], of[v]);
    for (std::uint32_t n = 0; n < arms_.size(); ++n)
      if (arms_[n].empty()) hubs_.hubs[n].joint = number_[hubs_.hubs[n].joint];
    for (const auto& [a, b] : old.segments)
      if (left[a] && left[b]) curve_.segments.push_back({number_[a], number_[b]});
    for (std::uint32_t n = 0; n < arms_.size(); ++n)
      if (!arms_[n].empty()) draw_star(n, of, old.part);
  }

  void draw_star(std::uint32_t number, std::span<const std::uint32_t> of,
                 std::span<const std::uint32_t> part) {
    std::vector<std::uint32_t> own;
    std::vector<Vec3> places;
    for (std::uint32_t v = 0; v < of.size(); ++v) {
      if (of[v] != number) continue;
      own.push_back(v);
      places.push_back(place(v));
    }
    const PointIndex index(places);
    const auto add_at = [&](const Vec3& at) {  // with the values of what is nearest
      const std::uint32_t like = own[index.find(at).number];
      return add(before_[like], at, part[like], number);
    };
    const std::uint32_t middle = add_at(hubs_.hubs[number].centre);
    hubs_.hubs[number].joint = middle;
    for (const Arm& arm : arms_[number]) {
      std::uint32_t last = number_[arm.from];
      for (const Vec3& at : arm.places) {
        const std::uint32_t next = add_at(at);
        curve_.segments.push_back({last, next});
        last = next;
      }
      curve_.segments.push_back({last, middle});
    }
    for (const std::uint32_t v : own) number_[v] = middle;
  }

  std::uint32_t add(SheetVertex vertex, const Vec3& at, std::uint32_t part, std::uint32_t hub) {
    vertex.position = at;
    curve_.vertices.push_back(vertex);
    curve_.part.push_back(part);
    hubs_.of.push_back(hub);
    return static_cast<std::uint32_t>(curve_.vertices.size() - 1);
  }

  const LimbSurface& surface_;
  const SolidMembership solid_;
  double spacing_;
  LimbHubs& hubs_;
  SheetMesh& curve_;
  const std::vector<SheetVertex> before_;
  const Adjacency beside_;
  std::vector<std::vector<Arm>> arms_;  // per hub; none of one that stays as it is
  std::vector<std::uint32_t> number_;   // per vertex before
};

}  // namespace

std::vector<std::uint32_t> draw_hub_stars(const LimbSurface& surface, double spacing, LimbHubs& hubs,
                                          SheetMesh& curve) {
  if (std::none_of(hubs.hubs.begin(), hubs.hubs.end(), is_plate)) return {};
  return HubStars(surface, spacing, hubs, curve).run();
}

}  // namespace affskel::core
