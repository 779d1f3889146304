#include "core/curve/pruned_lines.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

namespace affskel::core {
namespace {

using Line = std::vector<std::uint32_t>;

class Pruning {
 public:
  Pruning(const SheetLines& lines, std::span<const Vec3> places, std::span<const double> ball)
      : lines_(lines),
        places_(places),
        ball_(ball),
        segments_(lines.segments),
        beside_(lines.vertices.size()) {
    for (Segment& s : segments_) {
      s = ascending(s[0], s[1]);
      beside_[s[0]].push_back(s[1]);
      beside_[s[1]].push_back(s[0]);
    }
  }

  // The shortest first. What goes only leaves others farther outside.
  SheetLines run(ExecutionContext* context) {
    using Spur = std::pair<double, std::uint32_t>;
    std::priority_queue<Spur, std::vector<Spur>, std::greater<>> spurs;
    const auto look_at = [&](std::uint32_t end, double known) {
      const Line line = line_from(end);
      if (beside_[line.back()].size() < 3) return;
      const double beyond = beyond_rest(line);
      if (beyond >= kSpur) return;
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
  const Vec3& place(std::uint32_t v) const { return places_[lines_.vertices[v]]; }
  double ball(std::uint32_t v) const { return ball_[lines_.vertices[v]]; }

  void erase(std::uint32_t a, std::uint32_t b) {
    std::erase(segments_, ascending(a, b));
    std::erase(beside_[a], b);
    std::erase(beside_[b], a);
  }

  void erase(const Line& line) {
    for (std::size_t n = 1; n < line.size(); ++n) erase(line[n - 1], line[n]);
  }

  // How far the end of a line is outside the balls about what it hangs on, by their radii.
  double beyond_rest(const Line& line) const {
    std::vector<char> seen(beside_.size(), 0);
    for (const std::uint32_t v : line) seen[v] = 1;
    double least = HUGE_VAL;
    Line rest{line.back()};
    for (std::size_t n = 0; n < rest.size(); ++n) {
      const std::uint32_t u = rest[n];
      if (ball(u) > 0) least = std::min(least, norm(place(line.front()) - place(u)) / ball(u) - 1);
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
  std::span<const Vec3> places_;
  std::span<const double> ball_;
  std::vector<Segment> segments_;  // that are left
  std::vector<Line> beside_;       // per vertex, by them
};

}  // namespace

SheetLines pruned_lines(const SheetLines& lines, std::span<const Vec3> places, std::span<const double> ball,
                        ExecutionContext* context) {
  return Pruning(lines, places, ball).run(context);
}

}  // namespace affskel::core
