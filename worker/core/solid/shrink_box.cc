// At the minimum every projection of the points along an axis has its rectangle of least area, and one side
// of that lies on an edge of the projection's convex hull (Freeman & Shapira 1975).
#include "core/solid/shrink_box.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/axis_choice.h"
#include "core/mesh/box.h"

namespace affskel::core {
namespace {

// Relative gain of a turn below which it is rounding; and a bound of what may never end.
constexpr double kGain = 1e-13;
constexpr int kMaxRounds = 200;

struct Vec2 {
  double x = 0, y = 0;
};

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Counter-clockwise, by Andrew's monotone chain (1979); no point twice.
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<Vec2> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t base = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();  // the other pass begins with it
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

// Area of the rectangle with a side along the unit vector e.
double area_along(const std::vector<Vec2>& hull, const Vec2& e) {
  Box box;  // along e, and across
  for (const Vec2& p : hull) box.include(Vec3{e.x * p.x + e.y * p.y, e.x * p.y - e.y * p.x, 0});
  return box.sides().x * box.sides().y;
}

// The unit vector along the hull's best edge, turned by right angles to be the one nearest to (1, 0).
Vec2 best_side(const std::vector<Vec2>& hull, ExecutionContext* context) {
  StopCheck stop(context);
  Vec2 best{1, 0};
  double least = area_along(hull, best) * (1 - kGain);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 &a = hull[i], &b = hull[(i + 1) % hull.size()];
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
    if (!(length > 0)) continue;
    stop.did(hull.size());
    Vec2 e{dx / length, dy / length};
    while (e.x < std::abs(e.y) || e.y == e.x) e = {e.y, -e.x};
    const double area = area_along(hull, e);
    if (area >= least) continue;
    least = area;
    best = e;
  }
  return best;
}

// Turns the box about axis k; false when that gains nothing.
bool turn_about(std::size_t k, std::span<const Vec3> points, Matrix3& axes, ExecutionContext* context) {
  Vec3 &a = axes[(k + 1) % 3], &b = axes[(k + 2) % 3];
  std::vector<Vec2> flat;
  flat.reserve(points.size());
  for (const Vec3& p : points) flat.push_back({dot(a, p), dot(b, p)});
  const Vec2 side = best_side(convex_hull(std::move(flat)), context);
  if (side.y == 0) return false;
  const Vec3 turned = side.x * a + side.y * b;
  b = side.x * b - side.y * a;
  a = turned;
  axes = orthonormal(axes);
  return true;
}

double volume_of(std::span<const Vec3> points, const Matrix3& axes) {
  const Vec3 sides = box_of(points, axes).sides();
  return sides.x * sides.y * sides.z;
}

}  // namespace

FittedBox shrink_box(std::span<const Vec3> points, const Matrix3& start, ExecutionContext* context) {
  FittedBox box{orthonormal(start), 0};
  std::size_t idle = 0;
  for (int round = 0; round < kMaxRounds && idle < 3; ++round) {
    throw_if_stopped(context);
    idle = turn_about(static_cast<std::size_t>(round) % 3, points, box.axes, context) ? 0 : idle + 1;
  }
  box.volume = volume_of(points, box.axes);
  return box;
}

}  // namespace affskel::core
