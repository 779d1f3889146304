// The body is modelled for x >= 0 and mirrored.  All lengths are in mm.  The proportions follow the
// artists' canon of 7 1/2 heads of 240 mm: chin at 6 1/2 heads, crotch a little below the middle, knees
// at 2 heads, elbows at the waist.  The arms hang away from the trunk at kArmAngle, palms inward.
#include "core/body_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace affskel::core {
namespace {

/// A tapered capsule, the hull of two balls, squeezed along `flat` to `squeeze` times its thickness.
struct Limb {
  Vec3 a;
  double radius_a;
  Vec3 b;
  double radius_b;
  double blend;           // width of the smooth union with the limbs before it in the table
  double squeeze = 1;     // in (0, 1]
  Vec3 flat = {0, 1, 0};  // unit vector
};

constexpr double kArmAngle = 40 * std::numbers::pi / 180;  // from the vertical
constexpr Vec3 kShoulder{178, 8, 1432};

/// A point of the arm: `s` down along it from the shoulder, `y` to the back.
Vec3 on_arm(double s, double y) {
  return {kShoulder.x + s * std::sin(kArmAngle), y, kShoulder.z - s * std::cos(kArmAngle)};
}

void add_trunk(std::vector<Limb>& limbs) {
  limbs.push_back({{0, 0, 1345}, 158, {0, 0, 1225}, 142, 1, 0.72});       // rib cage
  limbs.push_back({{0, -6, 1225}, 138, {0, -4, 1050}, 138, 60, 0.72});    // waist
  limbs.push_back({{-58, 4, 958}, 112, {58, 4, 958}, 112, 70, 0.94});     // pelvis
  limbs.push_back({{66, 42, 912}, 80, {80, 40, 880}, 74, 50});            // seat
  limbs.push_back({{62, -62, 1352}, 66, {92, -50, 1372}, 56, 50, 0.62});  // chest muscles
  limbs.push_back({{-132, 14, 1432}, 60, {132, 14, 1432}, 60, 60});       // shoulder girdle
  limbs.push_back({{0, 22, 1500}, 58, {140, 14, 1448}, 44, 50});          // slope of the shoulders
}

void add_head(std::vector<Limb>& limbs) {
  limbs.push_back({{0, 14, 1470}, 62, {0, 2, 1600}, 55, 40});                      // neck
  limbs.push_back({{0, 8, 1698}, 102, {0, -22, 1668}, 88, 30, 0.80, {1, 0, 0}});   // skull
  limbs.push_back({{0, -34, 1648}, 62, {0, -52, 1606}, 42, 30, 0.86, {1, 0, 0}});  // jaw
  limbs.push_back({{0, -98, 1690}, 10, {0, -112, 1658}, 16, 18});                  // nose
}

void add_arm(std::vector<Limb>& limbs) {
  const Vec3 across{std::cos(kArmAngle), 0, std::sin(kArmAngle)};   // from the palm to the back of the hand
  limbs.push_back({kShoulder, 60, on_arm(90, 8), 54, 40});          // shoulder muscle
  limbs.push_back({on_arm(60, 8), 52, on_arm(290, 12), 41, 30});    // upper arm
  limbs.push_back({on_arm(290, 12), 41, on_arm(365, 6), 44, 30});   // elbow
  limbs.push_back({on_arm(365, 6), 44, on_arm(545, -10), 29, 30});  // forearm
  limbs.push_back({on_arm(545, -10), 30, on_arm(610, -14), 46, 25, 0.52, across});  // palm
  limbs.push_back({on_arm(610, -14), 46, on_arm(705, -18), 30, 25, 0.46, across});  // fingers
  limbs.push_back({on_arm(572, -36), 18, on_arm(640, -76), 14, 18});                // thumb
}

void add_leg(std::vector<Limb>& limbs) {
  limbs.push_back({{100, 4, 900}, 92, {122, 0, 690}, 76, 40});                       // upper thigh
  limbs.push_back({{122, 0, 690}, 76, {138, -4, 500}, 56, 40});                      // lower thigh
  limbs.push_back({{138, -6, 500}, 55, {144, 2, 420}, 53, 30});                      // knee
  limbs.push_back({{143, 12, 400}, 56, {148, 20, 300}, 54, 30});                     // calf
  limbs.push_back({{148, 18, 300}, 52, {154, 24, 95}, 35, 30});                      // shin
  limbs.push_back({{154, 36, 60}, 38, {155, 42, 32}, 38, 25});                       // heel
  limbs.push_back({{155, 10, 62}, 36, {166, -110, 30}, 46, 25, 0.86, {0, 0, 1}});    // instep
  limbs.push_back({{166, -110, 24}, 46, {171, -168, 18}, 36, 25, 0.62, {0, 0, 1}});  // toes
}

/// A limb with everything that does not depend on the point worked out.  In the space stretched along
/// `flat` it is round; scaling the distance there by `squeeze` keeps the Lipschitz constant at 1.
class LimbDistance {
 public:
  explicit LimbDistance(const Limb& limb)
      : flat_(limb.flat),
        stretch_(1 / limb.squeeze - 1),
        squeeze_(limb.squeeze),
        blend_(limb.blend),
        radius_a_(limb.radius_a),
        radius_b_(limb.radius_b),
        a_(stretched(limb.a)),
        b_(stretched(limb.b)) {
    const Vec3 axis = b_ - a_;
    length_ = norm(axis);
    axis_ = (1 / length_) * axis;
    sine_ = (radius_a_ - radius_b_) / length_;
    cosine_ = std::sqrt(1 - sine_ * sine_);
  }

  double blend() const { return blend_; }

  /// The outline of a section through the axis is two arcs and their common tangent; the foot of the
  /// tangent's normal on the axis tells which of the three is nearest.
  double operator()(const Vec3& point) const {
    const Vec3 p = stretched(point), from_a = p - a_;
    const double along = dot(from_a, axis_);
    const double across = std::sqrt(std::max(0.0, dot(from_a, from_a) - along * along));
    const double foot = along - across * sine_ / cosine_;
    if (foot <= 0) return squeeze_ * (norm(from_a) - radius_a_);
    if (foot >= length_) return squeeze_ * (norm(p - b_) - radius_b_);
    return squeeze_ * (across * cosine_ + along * sine_ - radius_a_);
  }

 private:
  Vec3 stretched(const Vec3& p) const { return p + (stretch_ * dot(flat_, p)) * flat_; }

  Vec3 flat_;
  double stretch_, squeeze_, blend_;
  double radius_a_, radius_b_;
  Vec3 a_, b_, axis_;
  double length_ = 0, sine_ = 0, cosine_ = 1;
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

/// Minimum with the edge rounded over the width `k`.  Twice continuously differentiable; the gradient is
/// a mean of the two gradients, so the Lipschitz constant stays 1.
double smooth_min(double a, double b, double k) {
  const double h = std::max(0.0, 1 - std::abs(a - b) / k);
  return std::min(a, b) - h * h * h * k / 6;
}

}  // namespace

double body_function(const Vec3& p) {
  const Vec3 mirrored{std::abs(p.x), p.y, p.z};
  double distance = 1e9;
  for (const LimbDistance& limb : limb_distances()) {
    distance = smooth_min(distance, limb(mirrored), limb.blend());
  }
  constexpr double kSoleEdge = 14;  // rounding of the edge of the flat soles
  return -smooth_min(-distance, p.z, kSoleEdge);
}

}  // namespace affskel::core
