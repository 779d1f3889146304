// Lines are spread over the solid's box by the R2 sequence (Roberts 2018); each point lies somewhere in its
// share of the length inside, by the golden ratio's sequence.
#include "core/quality/interior_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/solid/solid_frame.h"
#include "core/spatial/box_tree.h"
#include "core/spatial/ray_crossing.h"

namespace affskel::core {
namespace {

double fraction(double x) {
  return x - std::floor(x);
}

// An interval of a line along x that lies inside the solid.
struct Interval {
  Vec3 begin;
  double length;
};

// A solid turned so that its longest principal axis is x, met by lines along x.
class TurnedSolid {
 public:
  TurnedSolid(const Solid& solid, const Matrix3& frame)
      : mesh_(turned(solid.mesh, frame)), box_(box_of(mesh_)), tree_(boxes_of(mesh_)) {}

  // Appends the intervals inside of line number i.
  void cut(double i, std::vector<Interval>& intervals) {
    // 1/g and 1/g^2 with g^3 = g + 1.
    const Vec3 q = {box_.low[0], within(1, fraction(0.5 + i * 0.75487766624669276)),
                    within(2, fraction(0.5 + i * 0.56984029099805327))};
    constexpr double kFar = std::numeric_limits<double>::infinity();
    crossings_.clear();
    tree_.visit({{-kFar, q.y, q.z}, {kFar, q.y, q.z}}, [&](std::uint32_t index) {
      const Triangle& t = mesh_.triangles[index];
      const int round = winding_round_line(mesh_, t, q, 0);
      if (round != 0) crossings_.emplace_back(distance_along(mesh_, t, q, 0), -round);
    });
    std::sort(crossings_.begin(), crossings_.end());
    int winding = 0;
    for (std::size_t c = 0; c < crossings_.size(); ++c) {
      winding += crossings_[c].second;
      if (winding <= 0 || c + 1 == crossings_.size()) continue;
      const double begin = crossings_[c].first, length = crossings_[c + 1].first - begin;
      if (length > 0) intervals.push_back({{q.x + begin, q.y, q.z}, length});
    }
  }

 private:
  static Mesh turned(Mesh mesh, const Matrix3& frame) {
    for (Vec3& p : mesh.points) p = transposed_times(frame, p);
    return mesh;
  }

  double within(std::size_t axis, double part) const {
    return box_.low[axis] + part * (box_.high[axis] - box_.low[axis]);
  }

  Mesh mesh_;
  Box box_;
  BoxTree tree_;
  std::vector<std::pair<double, int>> crossings_;  // along the line; +1 into the solid, -1 out of it
};

// Half as many lines through the solid as points, so that the pattern shows neither lines nor rows on them.
std::vector<Interval> inside_intervals(TurnedSolid& solid, std::uint32_t count) {
  std::vector<Interval> intervals;
  const std::uint64_t most = std::uint64_t{8} * count;
  std::uint64_t hits = 0;
  for (std::uint64_t line = 0; line < most && 2 * hits < count; ++line) {
    const std::size_t before = intervals.size();
    solid.cut(static_cast<double>(line), intervals);
    hits += intervals.size() > before ? 1 : 0;
  }
  return intervals;
}

// Of the total length, cut into `count` equal steps, point i lies somewhere in step i.
std::vector<Vec3> spread(const std::vector<Interval>& intervals, std::uint32_t count) {
  double total = 0;
  for (const Interval& interval : intervals) total += interval.length;
  const double step = total / count;
  std::vector<Vec3> points;
  points.reserve(count);
  double swept = 0;
  for (const Interval& interval : intervals) {
    const bool last = &interval == &intervals.back();
    while (points.size() < count) {
      const auto i = static_cast<double>(points.size());
      const double at = (i + fraction(0.5 + i * 0.61803398874989485)) * step - swept;
      if (at > interval.length && !last) break;
      points.push_back(interval.begin + Vec3{std::clamp(at, 0.0, interval.length), 0, 0});
    }
    swept += interval.length;
  }
  return points;
}

}  // namespace

std::vector<Vec3> interior_points(const Solid& solid, std::uint32_t count) {
  const Matrix3 frame = solid_frame(solid, FrameKind::kPca);
  TurnedSolid turned(solid, frame);
  const std::vector<Interval> intervals = inside_intervals(turned, count);
  if (intervals.empty()) {
    refuse("the solid is so thin that none of " + std::to_string(std::uint64_t{8} * count) +
           " lines through its box meets its inside");
  }
  std::vector<Vec3> points = spread(intervals, count);
  for (Vec3& p : points) p = solid.centre + solid.scale() * (frame * p);
  return points;
}

}  // namespace affskel::core
