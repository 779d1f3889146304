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

namespace affskel::core {
namespace {

using Line = std::vector<std::uint32_t>;

class Pruning {
 public:
  Pruning(const SheetLines& lines, const SheetMesh& sheet, std::span<const double> ball, double least)
      : lines_(lines),
        sheet_(sheet),
        ball_(ball),
        least_(least),
        segments_(lines.segments),
        beside_(lines.vertices.size()),
        is_middle_(lines.vertices.size(), 0) {
    for (Segment& s : segments_) {
      s = ascending(s[0], s[1]);
      beside_[s[0]].push_back(s[1]);
      beside_[s[1]].push_back(s[0]);
    }
    mark_middles();
  }

  // The shortest first. What goes only leaves others farther outside.
  SheetLines run(ExecutionContext* context) {
    using Spur = std::pair<double, std::uint32_t>;
    std::priority_queue<Spur, std::vector<Spur>, std::greater<>> spurs;
    const auto look_at = [&](std::uint32_t end, double known) {
      const Line line = line_from(end);
      const bool leads_through_middle =
          std::any_of(line.begin(), line.end() - 1, [&](std::uint32_t v) { return is_middle_[v] != 0; });
      if (beside_[line.back()].size() < 3 || leads_through_middle) return;
      const auto [outside, beyond] = beyond_rest(line);
      if (beyond >= kSpur || outside >= kSlender * std::max(thickness_of(line, outside), least_)) return;
      if (beyond > known)
        spurs.push({beyond, end});
      else
        erase(line);
    };
    for (std::uint32_t v = 0; v < beside_.size(); ++v)
      if (beside_[v].size() == 1) look_at(v, -HUGE_VAL);
    while (!spurs.empty()) {
      throw_if_stopped(context);
      const auto [beyond, end] = spurs.top();
      spurs.pop();
      look_at(end, beyond);
    }
    return left_of(lines_, segments_);
  }

 private:
  const Vec3& place(std::uint32_t v) const { return sheet_.vertices[lines_.vertices[v]].position; }
  double ball(std::uint32_t v) const { return ball_[lines_.vertices[v]]; }

  // In each piece the vertex of the greatest E.
  void mark_middles() {
    DisjointSets pieces(beside_.size());
    for (const Segment& s : segments_) pieces.unite(s[0], s[1]);
    std::vector<std::uint32_t> middle(beside_.size());  // of what is known of a piece
    std::iota(middle.begin(), middle.end(), 0U);
    const auto erosion = [&](std::uint32_t v) { return sheet_.vertices[lines_.vertices[v]].erosion; };
    for (std::uint32_t v = 0; v < beside_.size(); ++v) {
      std::uint32_t& known = middle[pieces.find(v)];
      if (erosion(v) > erosion(known)) known = v;
    }
    for (std::uint32_t v = 0; v < beside_.size(); ++v)
      if (pieces.find(v) == v) is_middle_[middle[v]] = 1;
  }

  void erase(std::uint32_t a, std::uint32_t b) {
    std::erase(segments_, ascending(a, b));
    std::erase(beside_[a], b);
    std::erase(beside_[b], a);
  }

  void erase(const Line& line) {
    for (std::size_t n = 1; n < line.size(); ++n) erase(line[n - 1], line[n]);
  }

  // Of what leads out.
  double thickness_of(const Line& line, double outside) const {
    double most = 0;
    for (const std::uint32_t v : line)
      if (norm(place(v) - place(line.front())) < outside) most = std::max(most, ball(v));
    return most;
  }

  struct Beyond {
    double way = HUGE_VAL, radii = HUGE_VAL;
  };

  // How far the end of a line is outside the balls about what it hangs on.
  Beyond beyond_rest(const Line& line) const {
    std::vector<char> seen(beside_.size(), 0);
    for (const std::uint32_t v : line) seen[v] = 1;
    Beyond least;
    Line rest{line.back()};
    for (std::size_t n = 0; n < rest.size(); ++n) {
      const std::uint32_t u = rest[n];
      const double way = norm(place(line.front()) - place(u)) - ball(u);
      least.way = std::min(least.way, way);
      if (ball(u) > 0) least.radii = std::min(least.radii, way / ball(u));
      for (const std::uint32_t w : beside_[u])
        if (!std::exchange(seen[w], 1)) rest.push_back(w);
    }
    return least;
  }

  Line line_from(std::uint32_t end) const {
    Line line{end};
    for (std::uint32_t v = beside_[end].front(); line.push_back(v), beside_[v].size() == 2;)
      v = beside_[v][beside_[v][0] == line[line.size() - 2] ? 1 : 0];
    return line;
  }

  const SheetLines& lines_;
  const SheetMesh& sheet_;
  std::span<const double> ball_;
  double least_;                   // thickness
  std::vector<Segment> segments_;  // that are left
  std::vector<Line> beside_;       // per vertex, by them
  std::vector<char> is_middle_;    // per vertex
};

}  // namespace

SheetLines pruned_lines(const SheetLines& lines, const SheetMesh& sheet, std::span<const double> ball,
                        double least_thickness, ExecutionContext* context) {
  return Pruning(lines, sheet, ball, least_thickness).run(context);
}

}  // namespace affskel::core
