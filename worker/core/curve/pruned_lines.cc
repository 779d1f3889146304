#include "core/curve/pruned_lines.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/mesh/box.h"
#include "core/spatial/halved_nodes.h"

namespace affskel::core {
namespace {

using Line = std::vector<std::uint32_t>;

// Of some vertices.
struct Balls {
  Box middles;
  double greatest = 0;
};

class Pruning {
 public:
  Pruning(const SheetLines& lines, const SheetMesh& sheet, std::span<const double> ball, double least)
      : lines_(lines),
        sheet_(sheet),
        ball_(ball),
        least_(least),
        beside_(lines.vertices.size()),
        piece_(lines.vertices.size()),
        is_left_(lines.vertices.size(), 1),
        is_middle_(lines.vertices.size(), 0) {
    for (const Segment& s : lines.segments) {
      beside_[s[0]].push_back(s[1]);
      beside_[s[1]].push_back(s[0]);
    }
    mark_middles();
    std::vector<std::uint32_t> all(piece_.size());
    std::iota(all.begin(), all.end(), 0U);
    const auto balls_of = [&](std::span<const std::uint32_t> some) {
      Balls balls;
      for (const std::uint32_t v : some) {
        balls.middles.include(place(v));
        balls.greatest = std::max(balls.greatest, this->ball(v));
      }
      return balls;
    };
    balls_ = HalvedTree<Balls>(std::move(all), 1, balls_of, [this](std::uint32_t v) { return place(v); });
  }

  // The shortest first. What goes only leaves others farther outside.
  SheetLines run(ExecutionContext* context) {
    for (std::uint32_t v = 0; v < beside_.size(); ++v)
      if (beside_[v].size() == 1) look_at(v, -HUGE_VAL, context);
    while (!spurs_.empty()) {
      const auto [beyond, end] = spurs_.top();
      spurs_.pop();
      look_at(end, beyond, context);
    }
    std::vector<Segment> left;
    for (const auto& [a, b] : lines_.segments)
      if (std::find(beside_[a].begin(), beside_[a].end(), b) != beside_[a].end())
        left.push_back(ascending(a, b));
    return left_of(lines_, std::move(left));
  }

 private:
  const Vec3& place(std::uint32_t v) const { return sheet_.vertices[lines_.vertices[v]].position; }
  double ball(std::uint32_t v) const { return ball_[lines_.vertices[v]]; }

  // In each piece the vertex of the greatest E.
  void mark_middles() {
    DisjointSets pieces(beside_.size());
    for (const Segment& s : lines_.segments) pieces.unite(s[0], s[1]);
    std::vector<std::uint32_t> middle(beside_.size());  // of what is known of a piece
    std::iota(middle.begin(), middle.end(), 0U);
    const auto erosion = [&](std::uint32_t v) { return sheet_.vertices[lines_.vertices[v]].erosion; };
    for (std::uint32_t v = 0; v < beside_.size(); ++v) {
      std::uint32_t& known = middle[pieces.find(v)];
      if (erosion(v) > erosion(known)) known = v;
    }
    for (std::uint32_t v = 0; v < beside_.size(); ++v)
      if ((piece_[v] = pieces.find(v)) == v) is_middle_[middle[v]] = 1;
  }

  // @param known how far beyond the rest it was when others were there, radii.
  void look_at(std::uint32_t end, double known, ExecutionContext* context) {
    throw_if_stopped(context);
    if (beside_[end].size() != 1) return;  // it has gone with another
    const Line line = line_from(end);
    if (!is_spur(line)) return;
    const double beyond = beyond_rest(line, end).radii;
    if (beyond > known) return spurs_.push({beyond, end});
    const Line twin = twin_of(line, beyond);
    if (!twin.empty() && !is_spur(twin)) return;
    erase(line);
    if (twin.empty()) return;
    erase(twin);
    if (beside_[line.back()].size() == 1) look_at(line.back(), -HUGE_VAL, context);
  }

  bool is_spur(const Line& line) {
    if (beside_[line.back()].size() < 3) return false;
    // Its end mostly is the farthest; an arm may come back to the hip.
    return std::none_of(line.begin(), line.end() - 1,
                        [&](std::uint32_t v) { return is_middle_[v] != 0 || leads_out(line, v); });
  }

  // Another at the end of the same line, which is about as long beyond its middle: one of two alone would draw that line, which
  // ends between them, to its side.  Empty where there is none, or the line itself is no longer.
  Line twin_of(const Line& line, double beyond) {
    const std::uint32_t joint = line.back();
    if (beside_[joint].size() != 3) return {};
    Line twin;
    for (const std::uint32_t next : beside_[joint]) {
      if (next == line[line.size() - 2]) continue;
      Line other = line_along(joint, next);
      if (beside_[other.back()].size() != 1) continue;
      std::reverse(other.begin(), other.end());
      const double radii = beyond_rest(other, other.front()).radii;
      if (1 + std::min(beyond, radii) < kTwin * (1 + std::max(beyond, radii))) continue;
      if (!twin.empty()) return {};
      twin = std::move(other);
    }
    return twin;
  }

  void erase(std::uint32_t a, std::uint32_t b) {
    std::erase(beside_[a], b);
    std::erase(beside_[b], a);
  }

  void erase(const Line& line) {
    for (std::size_t n = 1; n < line.size(); ++n) erase(line[n - 1], line[n]);
    leave(line, 0);
  }

  // But for its last vertex, which is of what it hangs on.
  void leave(const Line& line, char is_left) {
    for (std::size_t n = 1; n < line.size(); ++n) is_left_[line[n - 1]] = is_left;
  }

  // Whether a line does, to one of its vertices.
  bool leads_out(const Line& line, std::uint32_t to) {
    const auto [outside, radii] = beyond_rest(line, to);
    double thickness = least_;
    for (const std::uint32_t v : line)
      if (norm(place(v) - place(to)) < outside) thickness = std::max(thickness, ball(v));
    return radii >= kSpur || outside >= kSlender * thickness;
  }

  struct Beyond {
    double way = HUGE_VAL, radii = HUGE_VAL;
  };

  // How far a vertex of a line is outside the balls about what that hangs on.
  Beyond beyond_rest(const Line& line, std::uint32_t vertex) {
    constexpr double kRounding = 1 + 1e-9;
    const Vec3 end = place(vertex);
    Beyond least;
    const auto compare = [&](std::uint32_t u) {
      if (!is_left_[u] || piece_[u] != piece_[line.back()]) return;
      const double way = norm(end - place(u)) - ball(u);
      least.way = std::min(least.way, way);
      if (ball(u) > 0) least.radii = std::min(least.radii, way / ball(u));
    };
    const auto may_have_less = [&](const Balls& balls) {
      const double way = std::sqrt(balls.middles.squared_distance(end));
      return way < kRounding * std::max(least.way + balls.greatest, (1 + least.radii) * balls.greatest);
    };
    leave(line, 0);
    compare(line.back());  // it is near
    balls_.visit_above(-1, may_have_less, compare);
    leave(line, 1);
    return least;
  }

  Line line_from(std::uint32_t end) const { return line_along(end, beside_[end].front()); }

  // To an end or a joint.
  Line line_along(std::uint32_t from, std::uint32_t next) const {
    Line line{from};
    for (std::uint32_t v = next; line.push_back(v), beside_[v].size() == 2;)
      v = beside_[v][beside_[v][0] == line[line.size() - 2] ? 1 : 0];
    return line;
  }

  const SheetLines& lines_;
  const SheetMesh& sheet_;
  std::span<const double> ball_;
  double least_;                                  // thickness
  std::vector<Line> beside_;                      // per vertex, by the segments that are left
  std::vector<std::uint32_t> piece_;              // per vertex
  std::vector<char> is_left_;                     // per vertex
  std::vector<char> is_middle_;                   // per vertex
  HalvedTree<Balls> balls_;                       // of all vertices
  using Spur = std::pair<double, std::uint32_t>;  // how far beyond the rest its end is, radii
  std::priority_queue<Spur, std::vector<Spur>, std::greater<>> spurs_;
};

}  // namespace

SheetLines pruned_lines(const SheetLines& lines, const SheetMesh& sheet, std::span<const double> ball,
                        double least_thickness, ExecutionContext* context) {
  return Pruning(lines, sheet, ball, least_thickness).run(context);
}

}  // namespace affskel::core
