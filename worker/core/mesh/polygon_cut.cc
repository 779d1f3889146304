#include "core/mesh/polygon_cut.h"

#include <algorithm>
#include <cmath>

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

class EarClipper {
 public:
  EarClipper(std::span<const Vec3> points, std::span<const std::uint32_t> corners)
      : points_(points), left_(corners.begin(), corners.end()), up_(polygon_area_vector(points, corners)) {}

  void run(std::vector<Triangle>& out) {
    while (left_.size() > 3) {
      const std::size_t ear = find_ear();
      if (ear == left_.size()) break;
      out.push_back({before(ear), left_[ear], after(ear)});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    cut_fan(left_, out);
  }

 private:
  std::uint32_t before(std::size_t i) const { return left_[(i + left_.size() - 1) % left_.size()]; }
  std::uint32_t after(std::size_t i) const { return left_[(i + 1) % left_.size()]; }

  double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return dot(twice_area(points_[a], points_[b], points_[c]), up_);
  }

  bool is_ear(std::size_t i) const {
    const std::uint32_t a = before(i), b = left_[i], c = after(i);
    if (!(turn(a, b, c) > 0)) return false;
    for (std::uint32_t p : left_) {
      if (p == a || p == b || p == c) continue;
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
  }

  std::size_t find_ear() const {
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if (is_ear(i)) return i;
    }
    return left_.size();
  }

  std::span<const Vec3> points_;
  std::vector<std::uint32_t> left_;
  Vec3 up_;
};

}  // namespace

Unevenness unevenness(std::span<const Vec3> points, std::span<const std::uint32_t> corners) {
  const Vec3 up = polygon_area_vector(points, corners);
  const double length = norm(up);
  Unevenness found;
  if (corners.size() == 4) {
    const Vec3& a = points[corners[0]];
    found.volume =
        std::abs(dot(points[corners[1]] - a, cross(points[corners[2]] - a, points[corners[3]] - a))) / 6;
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
