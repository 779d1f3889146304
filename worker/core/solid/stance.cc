#include "core/solid/stance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/error.h"
#include "core/mesh/box.h"
#include "core/solid/surface_samples.h"
#include "core/spatial/distance_to_mesh.h"

// Places are samples of the surface, evenly by area.  Coordinates are x, y, z by number, so that every rule is written
// once for all axes.  The figures behind the constants: 8 bodies of 292 to 107,024 triangles in three poses, and 20
// animals, busts and hands of CGAL's data (`stance_test` has such shapes of our own).

namespace affskel::core {
namespace {

constexpr std::size_t kSamples = 20000;
constexpr std::size_t kMirrored = 8;   // every eighth sample: each takes a search for the nearest triangle
constexpr double kMirrorImage = 0.05;  // mean distance of the halves by the side across: bodies 0.004 to 0.03
constexpr double kRound =
    0.015;  // from its image by a quarter turn: pentagons 0.008, arms spread as wide as high 0.036
constexpr double kTurned = 0.07;   // a vase about its width: 0.087
constexpr double kFlat = 0.5;      // of the surface at two ends: letters, gears 0.6; bodies, animals 0.14
constexpr double kNoImage = 0.01;  // beyond twice that: animals front to back 0.03 at least
constexpr double kClearlyLonger = 1.25;  // a body's height against its arms hanging obliquely: 1.5
constexpr double kFeet = 0.05;           // of the height
constexpr double kStands = 0.1;          // of the base: bodies 0.14 to 0.5, animals 0.2 to 0.5
constexpr double kStandsBetter = 1.5;    // a camel on its feet against on its rump: 1.9
constexpr double kClearlyWider = 1.25;   // a body with its arms hanging against its depth: 2
constexpr double kHeadAside = 0.1;       // by the longest side: animals 0.11 to 0.38, bodies to 0.04
constexpr double kFeetAside = 0.02;      // bodies 0.04 to 0.05

AxisDirection usual_front(AxisDirection up) {
  return up.axis == 2 ? AxisDirection{1, true} : AxisDirection{2, false};
}

class Shape {
 public:
  Shape(const Mesh& mesh, std::vector<Vec3> places)
      : distance_(mesh), places_(std::move(places)), box_(box_of(places_)) {
    for (const Vec3& place : places_)
      for (std::size_t a = 0; a < 3; ++a) middle_[a] += place[a] / double(places_.size());
    for (std::size_t a = 0; a < 3; ++a) unlikeness_[a] = unlike_mirror_image(a);
    for (std::size_t a = 0; a < 3; ++a)
      is_flat_[a] = side(a) <= std::min(side((a + 1) % 3), side((a + 2) % 3)) && share_of_ends(a) > kFlat;
  }

  AxisDirection up() const {
    const double turned_y = unlike_turned(1), turned_z = unlike_turned(2);
    if (turned_y < kRound && turned_z > kTurned) return {1, false};
    if ((turned_z < kRound && turned_y > kTurned) || is_flat_[1] || is_flat_[2]) return {2, false};
    const bool across_y = is_across(1, 0) && is_across(1, 2), across_z = is_across(2, 0) && is_across(2, 1);
    const double on_z = across_z ? 0 : spread_of_feet(2), on_y = across_y ? 0 : spread_of_feet(1);
    if (on_y >= kStands && on_y > kStandsBetter * on_z) return {1, false};
    if (on_z >= kStands && on_z > kStandsBetter * on_y) return {2, false};
    return {side(1) > kClearlyLonger * std::max(side(0), side(2)) ? 1U : 2U, false};
  }

  AxisDirection front(AxisDirection up) const {
    AxisDirection front = usual_front(up);
    if (is_flat_[up.axis]) return front;
    const std::size_t other = 3 - up.axis - front.axis;
    const bool stands = side(up.axis) >= std::max(side(front.axis), side(other));
    if (is_flat_[other] || (!is_flat_[front.axis] && (is_across(front.axis, other) ||
                                                      (!is_across(other, front.axis) && stands &&
                                                       side(front.axis) > kClearlyWider * side(other))))) {
      front = {other, false};
    }
    const double head = beside(up, 0.85, 1, front.axis) - middle_[front.axis];
    const double feet = beside(up, 0, 0.04, front.axis) - beside(up, 0.07, 0.15, front.axis);
    if (std::fabs(head) > kHeadAside * box_.longest_side()) {
      front.minus = head < 0;
    } else if (std::fabs(feet) > kFeetAside * box_.longest_side()) {
      front.minus = feet < 0;
    }
    return front;
  }

 private:
  double side(std::size_t axis) const { return box_.high[axis] - box_.low[axis]; }

  // How far the surface is from its mirror image in the mean, by the side across the mirror, which stands in the middle
  // of the box or of the surface, whichever suits better.
  double unlike_mirror_image(std::size_t axis) const {
    double least = HUGE_VAL;
    for (const double mirror : {(box_.low[axis] + box_.high[axis]) / 2, middle_[axis]}) {
      const double distance = mean_distance([&](Vec3& place) { place[axis] = 2 * mirror - place[axis]; });
      least = std::min(least, distance / side(axis));
    }
    return least;
  }

  // The same of what a quarter turn makes of it.
  double unlike_turned(std::size_t axis) const {
    const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
    const double centre_a = (box_.low[a] + box_.high[a]) / 2, centre_b = (box_.low[b] + box_.high[b]) / 2;
    const double distance = mean_distance([&](Vec3& place) {
      const double from_a = place[a] - centre_a;
      place[a] = centre_a + (place[b] - centre_b);
      place[b] = centre_b - from_a;
    });
    return distance / std::max(side(a), side(b));
  }

  // Of the images of places.
  template <typename Map>
  double mean_distance(const Map& map) const {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t p = 0; p < places_.size(); p += kMirrored, ++count) {
      Vec3 image = places_[p];
      map(image);
      sum += distance_.nearest(image);
    }
    return sum / double(count);
  }

  // How much of the surface lies at the two ends.
  double share_of_ends(std::size_t axis) const {
    const double end = kFeet * side(axis);
    const auto count = std::count_if(places_.begin(), places_.end(), [&](const Vec3& place) {
      return place[axis] <= box_.low[axis] + end || place[axis] >= box_.high[axis] - end;
    });
    return double(count) / double(places_.size());
  }

  // Whether left and right lie along an axis rather than along another one.
  bool is_across(std::size_t axis, std::size_t other) const {
    return unlikeness_[axis] < kMirrorImage && unlikeness_[other] > 2 * unlikeness_[axis] + kNoImage;
  }

  // The box round what it stands on, as a share of the whole's base; 0 when it would fall over.
  double spread_of_feet(std::size_t up) const {
    Box feet;
    for (const Vec3& place : places_)
      if (place[up] <= box_.low[up] + kFeet * side(up)) feet.include(place);
    double share = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      if (a == up) continue;
      if (!(feet.low[a] < middle_[a] && middle_[a] < feet.high[a])) return 0;
      share *= (feet.high[a] - feet.low[a]) / side(a);
    }
    return share;
  }

  // The mean along `axis` of what lies between two heights, shares of the whole; the middle where nothing does.
  double beside(AxisDirection up, double from, double to, std::size_t axis) const {
    double sum = 0;
    std::size_t count = 0;
    for (const Vec3& place : places_) {
      const double share = (place[up.axis] - box_.low[up.axis]) / side(up.axis);
      const double height = up.minus ? 1 - share : share;
      if (!(height >= from && height <= to)) continue;
      sum += place[axis];
      ++count;
    }
    return count > 0 ? sum / double(count) : middle_[axis];
  }

  DistanceToMesh distance_;
  std::vector<Vec3> places_;
  Box box_;
  Vec3 middle_, unlikeness_;
  std::array<bool, 3> is_flat_{};
};

// Empty where there is nothing to look at.
std::vector<Vec3> places_on(const Mesh& mesh) {
  constexpr double kLargest = 1e100;  // squares of lengths do not overflow
  for (const Vec3& p : mesh.points)
    if (!(std::fabs(p.x) < kLargest && std::fabs(p.y) < kLargest && std::fabs(p.z) < kLargest)) return {};
  try {
    return surface_samples(mesh, kSamples);
  } catch (const CoreError&) {
    return {};
  }
}

}  // namespace

Vec3 AxisDirection::vector() const {
  Vec3 vector;
  vector[axis] = minus ? -1 : 1;
  return vector;
}

Vec3 Stance::right() const {
  return cross(up.vector(), front.vector());
}

Stance find_stance(const Mesh& mesh, std::optional<AxisDirection> up) {
  const std::vector<Vec3> places = places_on(mesh);
  if (places.empty()) {
    up = up.value_or(AxisDirection{2, false});
    return {*up, usual_front(*up)};
  }
  const Shape shape(mesh, places);
  up = up.value_or(shape.up());
  return {*up, shape.front(*up)};
}

}  // namespace affskel::core
