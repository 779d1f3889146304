#include "core/mesh/polygon_cut.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace affskel::core {
namespace {

Vec3 twice_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return cross(b - a, c - a);
}

Vec3 polygon_area_vector(std::span<const Vec3> points, std::span<const std::uint32_t> corners) {
  Vec3 sum;
  const Vec3& origin = points[corners[0]];
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum = sum + cross(points[corners[i]] - origin, points[corners[i + 1]] - origin);
  }
  return sum;
}

void cut_fan(std::span<const std::uint32_t> corners, std::vector<Triangle>& out) {
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    out.push_back({corners[0], corners[i], corners[i + 1]});
}

void cut_quadrilateral(std::span<const Vec3> points, std::span<const std::uint32_t> q,
                       std::vector<Triangle>& out) {
  const Vec3 &a = points[q[0]], &b = points[q[1]], &c = points[q[2]], &d = points[q[3]];
  const Vec3 up = polygon_area_vector(points, q);
  const bool ac_valid = dot(twice_area(a, b, c), up) > 0 && dot(twice_area(a, c, d), up) > 0;
  const bool bd_valid = dot(twice_area(a, b, d), up) > 0 && dot(twice_area(b, c, d), up) > 0;
  const bool bd_shorter = dot(d - b, d - b) < dot(c - a, c - a);
  if (ac_valid == bd_valid ? bd_shorter : bd_valid) {
    out.push_back({q[0], q[1], q[3]});
    out.push_back({q[1], q[2], q[3]});
  } else {
    cut_fan(q, out);
  }
}

// Corners are known by their place in the ring.  Of those left, only such as are not convex can lie in an ear, so
// these alone are looked at; and cutting an ear off changes what holds of its two neighbours alone.  Where rings touch
// themselves that is not all true, so all corners are tried again a few times before a fan is taken.
class EarClipper {
 public:
  EarClipper(std::span<const Vec3> points, std::span<const std::uint32_t> corners)
      : corners_(corners), up_(polygon_area_vector(points, corners)) {
    const auto size = static_cast<std::uint32_t>(corners.size());
    for (std::uint32_t i = 0; i < size; ++i) {
      places_.push_back(points[corners[i]]);
      before_.push_back((i + size - 1) % size);
      after_.push_back((i + 1) % size);
    }
  }

  void run(std::vector<Triangle>& out) {
    std::size_t left = corners_.size();
    for (int trial = 0; trial < kTrials && left > 3; ++trial) {
      look_at_all();
      for (; left > 3 && !ears_.empty(); --left) cut_off(*ears_.begin(), out);
    }
    std::vector<std::uint32_t> rest;
    for (std::uint32_t i = first_; rest.size() < left; i = after_[i]) rest.push_back(corners_[i]);
    cut_fan(rest, out);
  }

 private:
  static constexpr int kTrials = 8;

  bool is_convex(std::uint32_t i) const {
    return dot(twice_area(places_[before_[i]], places_[i], places_[after_[i]]), up_) > 0;
  }

  void look_at_all() {
    hollow_.clear();
    std::uint32_t i = first_;
    do {
      if (!is_convex(i)) hollow_.push_back({places_[i], i});
      i = after_[i];
    } while (i != first_);
    do {
      if (is_ear(i)) ears_.insert(i);
      i = after_[i];
    } while (i != first_);
  }

  // A corner at the place of one of the ear's is its twin, where a bridge leads to a hole and back, and not in its way.
  bool is_ear(std::uint32_t i) const {
    if (!is_convex(i)) return false;
    const Vec3 &a = places_[before_[i]], &b = places_[i], &c = places_[after_[i]];
    const Vec3 into_ca = cross(up_, a - c), into_ab = cross(up_, b - a), into_bc = cross(up_, c - b);
    return std::none_of(hollow_.begin(), hollow_.end(), [&](const Hollow& other) {
      const Vec3& p = other.place;
      return dot(into_ca, p - c) >= 0 && dot(into_ab, p - a) >= 0 && dot(into_bc, p - b) >= 0 && p != a &&
             p != b && p != c;
    });
  }

  void cut_off(std::uint32_t ear, std::vector<Triangle>& out) {
    const std::uint32_t a = before_[ear], c = after_[ear];
    out.push_back({corners_[a], corners_[ear], corners_[c]});
    after_[a] = c;
    before_[c] = a;
    if (first_ == ear) first_ = c;
    ears_.erase(ear);
    std::erase_if(hollow_,
                  [&](const Hollow& h) { return (h.corner == a || h.corner == c) && is_convex(h.corner); });
    for (const std::uint32_t i : {a, c}) {
      if (is_ear(i))
        ears_.insert(i);
      else
        ears_.erase(i);
    }
  }

  struct Hollow {
    Vec3 place;
    std::uint32_t corner;
  };

  std::span<const std::uint32_t> corners_;
  Vec3 up_;
  std::vector<Vec3> places_;
  std::vector<std::uint32_t> before_, after_;  // of those left
  std::uint32_t first_ = 0;                    // of those left
  std::vector<Hollow> hollow_;                 // of those left, where the ring does not turn to the left
  std::set<std::uint32_t> ears_;               // the first one is cut off
};

}  // namespace

Unevenness unevenness(std::span<const Vec3> points, std::span<const std::uint32_t> corners) {
  const Vec3 up = polygon_area_vector(points, corners);
  const double length = norm(up);
  Unevenness found;
  if (corners.size() == 4) {
    const Vec3& a = points[corners[0]];
    found.volume = std::abs(six_volumes(a, points[corners[1]], points[corners[2]], points[corners[3]])) / 6;
  }
  if (!(length > 0)) return found;
  Vec3 mean;
  for (const std::uint32_t v : corners) mean = mean + (1.0 / static_cast<double>(corners.size())) * points[v];
  for (const std::uint32_t v : corners)
    found.distance = std::max(found.distance, std::abs(dot(points[v] - mean, up)) / length);
  if (corners.size() > 4) found.volume = 0.5 * length * found.distance;
  return found;
}

void cut_polygon(std::span<const Vec3> points, std::span<const std::uint32_t> corners,
                 std::vector<Triangle>& out) {
  if (corners.size() == 4) {
    cut_quadrilateral(points, corners, out);
  } else if (corners.size() > 4 && corners.size() <= kMaxEarCorners) {
    EarClipper(points, corners).run(out);
  } else {
    cut_fan(corners, out);
  }
}

}  // namespace affskel::core
