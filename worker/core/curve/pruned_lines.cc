#include "core/curve/pruned_lines.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <set>
#include <utility>
#include <vector>

#include "core/base/cheapest_ways.h"
#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

using Line = std::vector<std::uint32_t>;

class Pruning {
 public:
  Pruning(const SheetLines& lines, std::span<const Vec3> places, std::span<const double> ball,
          std::vector<char>& ends, const PruningOptions& options)
      : lines_(lines),
        places_(places),
        ball_(ball),
        options_(options),
        ends_(ends),
        segments_(lines.segments),
        beside_(lines.vertices.size()) {
    for (Segment& s : segments_) {
      if (s[0] > s[1]) std::swap(s[0], s[1]);
      beside_[s[0]].push_back(s[1]);
      beside_[s[1]].push_back(s[0]);
    }
  }

  SheetLines run() {
    for (std::uint64_t n = 0; n < options_.most_loops; ++n) {
      throw_if_stopped(options_.context);
      if (!open_one()) break;
    }
    eat();
    eat_spurs();
    return left_of(lines_, segments_);
  }

 private:
  const Vec3& place(std::uint32_t v) const { return places_[lines_.vertices[v]]; }
  double ball(std::uint32_t v) const { return ball_[lines_.vertices[v]]; }

  bool open_one() {
    std::vector<std::pair<double, Line>> order;  // by the smallest ball
    for (Line& line : polylines(lines_.vertices.size(), segments_)) {
      double least = ball(line.front());
      for (const std::uint32_t v : line) least = std::min(least, ball(v));
      order.emplace_back(least, std::move(line));
    }
    std::sort(order.begin(), order.end());
    for (const auto& [least, line] : order) {
      if (large_.contains(line)) continue;
      if (is_small(line)) {
        open(line);
        return true;
      }
      large_.insert(line);
    }
    return false;
  }

  // Whether a line closes a loop that lies in a ball about one of its places.
  bool is_small(const Line& line) const {
    Line loop = line;
    if (line.front() != line.back() && !close(loop)) return false;
    const std::uint32_t middle = *std::max_element(
        loop.begin(), loop.end(), [&](std::uint32_t a, std::uint32_t b) { return ball(a) < ball(b); });
    return std::all_of(loop.begin(), loop.end(), [&](std::uint32_t v) {
      return norm(place(v) - place(middle)) < kHandle * ball(middle);
    });
  }

  // By the shortest way back.
  bool close(Line& loop) const {
    const std::uint32_t from = loop.front(), to = loop.back(), next = loop[1], before = loop[loop.size() - 2];
    std::vector<std::uint32_t> sources(lines_.vertices.size(), kNoNode);
    sources[from] = from;
    CheapestWays ways(std::move(sources));
    ways.find([&](std::uint32_t v, const auto& go) {
      for (const std::uint32_t w : beside_[v])
        if (!(v == from && w == next) && !(v == before && w == to)) go(w, norm(place(w) - place(v)), v);
    });
    if (ways.source[to] == kNoNode) return false;
    for (std::uint32_t v = to; v != from; v = ways.step[v]) loop.push_back(v);
    return true;
  }

  // Where the ball is smallest.
  void open(const Line& line) {
    std::size_t weakest = 1;
    const auto ball_at = [&](std::size_t n) { return std::min(ball(line[n - 1]), ball(line[n])); };
    for (std::size_t n = 2; n < line.size(); ++n)
      if (ball_at(n) < ball_at(weakest)) weakest = n;
    const std::uint32_t a = line[weakest - 1], b = line[weakest];
    erase(a, b);
    loose_.insert(loose_.end(), {a, b});
  }

  void erase(std::uint32_t a, std::uint32_t b) {
    std::erase(segments_, Segment{std::min(a, b), std::max(a, b)});
    std::erase(beside_[a], b);
    std::erase(beside_[b], a);
  }

  void erase(const Line& line) {
    for (std::size_t n = 1; n < line.size(); ++n) erase(line[n - 1], line[n]);
  }

  // What hangs loose then, the shortest first, but for the line of a limb: while the solid is thinned a limb with a tunnel
  // at its end is a loop, and has no tip.
  void eat() {
    while (true) {
      std::erase_if(loose_,
                    [&](std::uint32_t v) { return beside_[v].size() != 1 || ends_[lines_.vertices[v]]; });
      if (loose_.empty()) return;
      std::vector<std::pair<double, Line>> order;
      for (const std::uint32_t end : loose_) {
        Line line = line_from(end);
        const double length = norm(place(end) - place(line.back()));
        order.emplace_back(length, std::move(line));
      }
      const Line& line = std::min_element(order.begin(), order.end())->second;
      if (is_limb(line))
        ends_[lines_.vertices[line.front()]] = 1;
      else
        erase(line);
    }
  }

  // Ends near the surface of what they leave, the shortest first. What goes only leaves others farther outside.
  void eat_spurs() {
    using Spur = std::pair<double, std::uint32_t>;
    std::priority_queue<Spur, std::vector<Spur>, std::greater<>> spurs;
    const auto look_at = [&](std::uint32_t end, double known) {
      const Line line = line_from(end);
      if (beside_[line.back()].size() < 3) return;
      const double beyond = beyond_others(line);
      if (beyond >= kSpur) return;
      if (beyond > known)
        spurs.push({beyond, end});
      else
        erase(line);
    };
    for (std::uint32_t v = 0; v < beside_.size(); ++v)
      if (beside_[v].size() == 1) look_at(v, -HUGE_VAL);
    while (!spurs.empty()) {
      throw_if_stopped(options_.context);
      const auto [beyond, end] = spurs.top();
      spurs.pop();
      look_at(end, beyond);
    }
  }

  // How far the end of a line is outside the balls about the others, by their radii.
  double beyond_others(const Line& line) const {
    double least = HUGE_VAL;
    std::vector<char> own(beside_.size(), 0);
    for (std::size_t n = 0; n + 1 < line.size(); ++n) own[line[n]] = 1;
    for (std::uint32_t u = 0; u < beside_.size(); ++u)
      if (!own[u] && !beside_[u].empty() && ball(u) > 0)
        least = std::min(least, norm(place(line.front()) - place(u)) / ball(u) - 1);
    return least;
  }

  Line line_from(std::uint32_t end) const {
    Line line{end};
    for (std::uint32_t v = beside_[end].front(); line.push_back(v), beside_[v].size() == 2;)
      v = beside_[v][beside_[v][0] == line[line.size() - 2] ? 1 : 0];
    return line;
  }

  bool is_limb(const Line& line) const {
    const std::uint32_t root = line.back();
    const auto from_root = [&](std::uint32_t v) { return norm(place(v) - place(root)); };
    const auto leaves =
        std::find_if(line.rbegin(), line.rend(), [&](std::uint32_t v) { return from_root(v) >= ball(root); });
    return leaves != line.rend() &&
           from_root(line.front()) - ball(root) >= options_.least_reach * ball(*leaves) &&
           beyond_others(line) >= kSpur;
  }

  const SheetLines& lines_;
  std::span<const Vec3> places_;
  std::span<const double> ball_;
  const PruningOptions& options_;
  std::vector<char>& ends_;
  std::vector<Segment> segments_;     // that are left
  std::vector<std::uint32_t> loose_;  // where loops were opened
  std::vector<Line> beside_;          // per vertex, by them
  std::set<Line> large_;  // that close no loop within a ball: with less beside them they do not either
};

}  // namespace

SheetLines pruned_lines(const SheetLines& lines, std::span<const Vec3> places, std::span<const double> ball,
                        std::vector<char>& ends, const PruningOptions& options) {
  return Pruning(lines, places, ball, ends, options).run();
}

}  // namespace affskel::core
