// The body is modelled for x >= 0 and mirrored.  All lengths are in mm.  The proportions follow the
// artists' canon of 7 1/2 heads of 240 mm: chin at 6 1/2 heads, crotch a little below the middle, knees
// at 2 heads, elbows at the waist.
#include "core/shapes/body_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace affskel::core {
namespace {

/// A ball on the axis of a limb.
struct Station {
  Vec3 centre;
  double radius;
};

/// The hull of each two successive balls of a chain, squeezed along `flat` to `squeeze` times its
/// thickness.  More than two stations stand for the smooth curve through them.
struct Limb {
  std::vector<Station> stations;
  double blend;           // width of the smooth union with the limbs before it
  double squeeze = 1;     // in (0, 1]
  Vec3 flat = {0, 1, 0};  // unit vector
};

constexpr Vec3 kX{1, 0, 0}, kZ{0, 0, 1};

void add_trunk(std::vector<Limb>& limbs) {
  limbs.push_back({{{{0, 10, 1375}, 148},
                    {{0, 4, 1290}, 158},
                    {{0, -4, 1200}, 142},
                    {{0, -10, 1110}, 128},
                    {{0, -6, 1010}, 132}},
                   1,
                   0.75});                                                       // chest to belly
  limbs.push_back({{{{-64, 4, 948}, 108}, {{64, 4, 948}, 108}}, 70, 0.94});      // pelvis
  limbs.push_back({{{{62, 46, 928}, 78}, {{78, 44, 890}, 76}}, 50});             // seat
  limbs.push_back({{{{56, -62, 1352}, 64}, {{100, -46, 1382}, 52}}, 44, 0.62});  // chest muscles
  limbs.push_back({{{{114, 28, 1378}, 50}, {{94, 18, 1220}, 40}}, 60});          // back muscles
  limbs.push_back({{{{-140, 14, 1450}, 52}, {{140, 14, 1450}, 52}}, 56});        // shoulder girdle
  limbs.push_back({{{{0, 26, 1520}, 48}, {{140, 16, 1466}, 38}}, 50});           // slope of the shoulders
}

void add_head(std::vector<Limb>& limbs) {
  limbs.push_back({{{{0, 20, 1470}, 62}, {{0, 6, 1610}, 55}}, 40});               // neck
  limbs.push_back({{{{0, 12, 1706}, 94}, {{0, 2, 1690}, 92}}, 30, 0.83, kX});     // skull
  limbs.push_back({{{{0, -20, 1672}, 78}, {{0, -40, 1606}, 52}}, 26, 0.86, kX});  // face and jaw
  limbs.push_back({{{{0, -92, 1694}, 9}, {{0, -104, 1660}, 15}}, 16});            // nose
  limbs.push_back({{{{76, 14, 1664}, 9}, {{80, 20, 1694}, 15}}, 10, 0.7, kX});    // ear
}

/// The arm hangs kArmAngle from the vertical, the forearm less and a little to the front.
void add_arm(std::vector<Limb>& limbs) {
  constexpr double kArmAngle = 42 * std::numbers::pi / 180, kForearmAngle = 36 * std::numbers::pi / 180;
  constexpr double kPalmTurn = 40 * std::numbers::pi / 180;  // of the palms, from inward to the back
  const Vec3 shoulder{172, 12, 1446};
  const Vec3 down{std::sin(kArmAngle), 0.02, -std::cos(kArmAngle)};
  const auto upper = [&](double s) { return shoulder + s * down; };
  const Vec3 elbow = upper(300);
  const Vec3 along{std::sin(kForearmAngle), -0.16, -std::cos(kForearmAngle)};
  const auto lower = [&](double s) { return elbow + s * along; };
  const Vec3 across{std::cos(kForearmAngle), 0, std::sin(kForearmAngle)};
  const Vec3 palm = std::cos(kPalmTurn) * across + Vec3{0, std::sin(kPalmTurn), 0};
  limbs.push_back({{{shoulder, 59},
                    {upper(90), 54},
                    {upper(190), 48},
                    {elbow, 39},
                    {lower(80), 44},
                    {lower(165), 37},
                    {lower(240), 28},
                    {lower(275), 29}},
                   40});
  limbs.push_back({{{lower(255), 34}, {lower(315), 49}, {lower(385), 42}}, 20, 0.54, palm});  // hand
  limbs.push_back(
      {{{lower(275) + Vec3{-10, -22, 0}, 19}, {lower(335) + Vec3{-32, -58, 0}, 15}}, 16});  // thumb
}

void add_leg(std::vector<Limb>& limbs) {
  limbs.push_back({{{{94, 4, 900}, 90},
                    {{110, -6, 790}, 90},
                    {{122, -8, 650}, 74},
                    {{134, -4, 530}, 56},
                    {{139, -2, 475}, 53},
                    {{143, 12, 390}, 57},
                    {{149, 22, 310}, 54},
                    {{154, 22, 190}, 38},
                    {{156, 24, 95}, 34}},
                   40});
  limbs.push_back({{{{156, 30, 90}, 34}, {{157, 44, 30}, 36}}, 20});                // heel
  limbs.push_back({{{{156, 12, 74}, 36}, {{168, -106, 30}, 46}}, 25, 0.86, kZ});    // instep
  limbs.push_back({{{{168, -106, 24}, 46}, {{174, -164, 17}, 40}}, 20, 0.66, kZ});  // toes
}

/// Catmull-Rom curve through the stations, kSteps balls per span.
std::vector<Station> smooth_chain(const std::vector<Station>& knots) {
  if (knots.size() < 3) return knots;
  constexpr int kSteps = 4;
  std::vector<Station> chain{knots.front()};
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const Station &p = knots[i > 0 ? i - 1 : i], &q = knots[i], &r = knots[i + 1],
                  &s = knots[i + 2 < knots.size() ? i + 2 : i + 1];
    for (int k = 1; k <= kSteps; ++k) {
      const double t = double(k) / kSteps;
      const double wp = ((2 - t) * t - 1) * t / 2, wq = ((3 * t - 5) * t * t + 2) / 2,
                   wr = ((4 - 3 * t) * t + 1) * t / 2, ws = (t - 1) * t * t / 2;
      chain.push_back({wp * p.centre + wq * q.centre + wr * r.centre + ws * s.centre,
                       wp * p.radius + wq * q.radius + wr * r.radius + ws * s.radius});
    }
  }
  return chain;
}

/// The hull of two balls, neither inside the other.
class Capsule {
 public:
  Capsule(const Station& a, const Station& b)
      : a_(a),
        b_(b),
        length_(norm(b.centre - a.centre)),
        axis_((1 / length_) * (b.centre - a.centre)),
        sine_((a.radius - b.radius) / length_),
        cosine_(std::sqrt(1 - sine_ * sine_)) {}

  /// The outline of a section through the axis is two arcs and their common tangent; the foot on the
  /// axis of the tangent's normal through p tells which of the three is nearest.
  double distance(const Vec3& p) const {
    const Vec3 from_a = p - a_.centre;
    const double along = dot(from_a, axis_);
    const double across = std::sqrt(std::max(0.0, dot(from_a, from_a) - along * along));
    const double foot = along - across * sine_ / cosine_;
    if (foot <= 0) return norm(from_a) - a_.radius;
    if (foot >= length_) return norm(p - b_.centre) - b_.radius;
    return across * cosine_ + along * sine_ - a_.radius;
  }

 private:
  Station a_, b_;
  double length_;
  Vec3 axis_;
  double sine_, cosine_;  // of the angle between axis and tangent
};

/// A limb with everything that does not depend on the point worked out.  In the space stretched along
/// `flat` it is round; scaling the distance there by `squeeze` keeps the Lipschitz constant at 1.
class LimbDistance {
 public:
  explicit LimbDistance(const Limb& limb)
      : flat_(limb.flat), stretch_(1 / limb.squeeze - 1), squeeze_(limb.squeeze), blend_(limb.blend) {
    std::vector<Station> chain = smooth_chain(limb.stations);
    for (Station& station : chain) station.centre = stretched(station.centre);
    middle_ = 0.5 * (chain.front().centre + chain.back().centre);
    for (std::size_t i = 0; i < chain.size(); ++i) {
      reach_ = std::max(reach_, norm(chain[i].centre - middle_) + chain[i].radius);
      if (i > 0) capsules_.emplace_back(chain[i - 1], chain[i]);
    }
  }

  double blend() const { return blend_; }

  /// The distance, or anything above `enough` when the distance is above it too.
  double operator()(const Vec3& point, double enough) const {
    const Vec3 p = stretched(point);
    const double bound = squeeze_ * (norm(p - middle_) - reach_);
    if (bound > enough) return bound;
    double distance = std::numeric_limits<double>::infinity();
    for (const Capsule& capsule : capsules_) distance = std::min(distance, capsule.distance(p));
    return squeeze_ * distance;
  }

 private:
  Vec3 stretched(const Vec3& p) const { return p + (stretch_ * dot(flat_, p)) * flat_; }

  Vec3 flat_;
  double stretch_, squeeze_, blend_;
  Vec3 middle_;
  double reach_ = 0;  // radius of a ball about middle_ that holds the stretched limb
  std::vector<Capsule> capsules_;
};

const std::vector<LimbDistance>& limb_distances() {
  static const std::vector<LimbDistance> distances = [] {
    std::vector<Limb> limbs;
    add_trunk(limbs);
    add_head(limbs);
    add_arm(limbs);
    add_leg(limbs);
    return std::vector<LimbDistance>(limbs.begin(), limbs.end());
  }();
  return distances;
}

/// Minimum with the edge rounded over the width `k`: plain from |a - b| = k on.  Twice continuously
/// differentiable; the gradient is a mean of the two gradients, so the Lipschitz constant stays 1.
double smooth_min(double a, double b, double k) {
  const double h = std::max(0.0, 1 - std::abs(a - b) / k);
  return std::min(a, b) - h * h * h * k / 6;
}

}  // namespace

double body_function(const Vec3& p) {
  const Vec3 mirrored{std::abs(p.x), p.y, p.z};
  double distance = 1e6;  // further than anything
  for (const LimbDistance& limb : limb_distances()) {
    distance = smooth_min(distance, limb(mirrored, distance + limb.blend()), limb.blend());
  }
  constexpr double kSoleEdge = 14;  // rounding of the edge of the flat soles
  return -smooth_min(-distance, p.z, kSoleEdge);
}

}  // namespace affskel::core
