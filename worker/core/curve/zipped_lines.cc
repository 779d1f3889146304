#include "core/curve/zipped_lines.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <tuple>
#include <utility>

#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

using Line = std::vector<std::uint32_t>;

// A line beside another, both from the same joint on.
struct Beside {
  std::uint32_t sliding = 0, other = 0;  // lines
  bool sliding_back = false, other_back = false;
  std::size_t leaves = 0,
              at = 0;  // the last vertex of the one that is beside the other, and which of that it is beside
  double length = 0;

  // The longest first.
  bool operator<(const Beside& that) const {
    if (length != that.length) return length > that.length;
    const auto order = [](const Beside& one) {
      return std::tie(one.sliding, one.other, one.sliding_back, one.other_back);
    };
    return order(*this) < order(that);
  }
};

class Zip {
 public:
  Zip(const SheetLines& lines, std::span<const char> ends, std::span<const double> ball, double spacing,
      std::vector<Vec3>& places)
      : lines_(lines),
        ends_(ends),
        ball_(ball),
        spacing_(spacing),
        places_(places),
        at_(lines.vertices.size()),
        longest_at_(lines.vertices.size()),
        is_stale_(lines.vertices.size(), 0) {
    for (Line& line : polylines(lines.vertices.size(), lines.segments)) add(std::move(line));
  }

  SheetLines run(ExecutionContext* context) {
    // Each slide leaves less that runs side by side; the bound is for what nobody has thought of.
    for (std::size_t n = 4 * parts_.size(); n > 0; --n) {
      throw_if_stopped(context);
      find_longest();
      if (longest_.empty()) break;
      slide(*longest_.begin());
    }
    return left_of(lines_, segments());
  }

 private:
  const Vec3& place(std::uint32_t v) const { return places_[lines_.vertices[v]]; }
  double ball(std::uint32_t v) const { return ball_[lines_.vertices[v]]; }
  double distance(std::uint32_t a, std::uint32_t b) const { return norm(place(a) - place(b)); }

  void add(Line line) {
    parts_.push_back(std::move(line));
    put_ends(static_cast<std::uint32_t>(parts_.size() - 1));
  }

  void put_ends(std::uint32_t number) {
    const Line& line = parts_[number];
    for (const bool back : {false, true}) {
      const std::uint32_t v = back ? line.back() : line.front();
      at_[v].push_back({number, back});
      call_stale(v);
    }
  }

  // Its line stays to be taken; the numbers of the others stay.
  Line taken(std::uint32_t number) {
    Line line = std::exchange(parts_[number], {});
    for (const std::uint32_t v : {line.front(), line.back()}) {
      std::erase_if(at_[v], [&](const LineEnd& end) { return end.line == number; });
      call_stale(v);
    }
    return line;
  }

  void call_stale(std::uint32_t joint) {
    if (!is_stale_[joint]) stale_.push_back(joint);
    is_stale_[joint] = 1;
  }

  std::vector<Segment> segments() const {
    std::vector<Segment> result;
    for (const Line& line : parts_)
      for (std::size_t k = 1; k < line.size(); ++k) result.push_back(ascending(line[k - 1], line[k]));
    std::sort(result.begin(), result.end());
    return result;
  }

  static Line turned(const Line& line, bool back) { return back ? Line(line.rbegin(), line.rend()) : line; }

  void find_longest() {
    for (const std::uint32_t joint : stale_) {
      longest_.erase(longest_at_[joint]);
      longest_at_[joint] = longest_at(joint);
      if (longest_at_[joint].length > 0) longest_.insert(longest_at_[joint]);
      is_stale_[joint] = 0;
    }
    stale_.clear();
  }

  Beside longest_at(std::uint32_t joint) const {
    Beside best;
    for (const LineEnd& a : at_[joint]) {
      const Line p = turned(parts_[a.line], a.back);
      if (p.size() < 3) continue;
      for (const LineEnd& b : at_[joint]) {
        if (a.line == b.line) continue;
        const Line q = turned(parts_[b.line], b.back);
        Beside found = beside(p, q);
        if (found.length == 0) continue;
        found.sliding = a.line;
        found.other = b.line;
        found.sliding_back = a.back;
        found.other_back = b.back;
        if (best.length == 0 || found < best) best = found;
      }
    }
    return best;
  }

  // Of length 0 where p does not leave the ball of the joint beside q, or has the greater balls.
  Beside beside(const Line& p, const Line& q) const {
    Beside found;
    double more = 0, length = 0;
    for (std::size_t k = 1, j = 0; k + 1 < p.size(); ++k) {
      // Lines come in steps of the lattice: the next vertex may be farther and those after it nearer.
      for (std::size_t n = j + 1; n + 1 < q.size() && distance(q[n], q[j]) <= ball(q[j]); ++n)
        if (distance(p[k], q[n]) <= distance(p[k], q[j])) j = n;
      if (distance(p[k], q[j]) > std::min(ball(p[k]), ball(q[j]))) break;
      length += distance(p[k - 1], p[k]);
      more += ball(q[j]) - ball(p[k]);
      const auto in_ball = [&](std::uint32_t v) { return distance(v, p[0]) <= ball(p[0]); };
      if (j == 0 || (at_[p[0]].size() > 2 && (in_ball(p[k]) || in_ball(q[j])))) continue;
      found.leaves = k;
      found.at = j;
      found.length = length;
    }
    const bool is_other = more > 0 || (more == 0 && p[1] > q[1]);
    return is_other ? found : Beside{};
  }

  void slide(const Beside& found) {
    Line p = turned(taken(found.sliding), found.sliding_back);
    Line q = turned(taken(found.other), found.other_back);
    const std::uint32_t joint = q.front(), to = q[found.at], from = p[found.leaves];
    const auto between = std::min(found.leaves - 1, static_cast<std::size_t>(distance(to, from) / spacing_));
    const Vec3 begin = place(to), end = place(from);
    p.erase(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(found.leaves - between));
    for (std::size_t k = 0; k < between; ++k)
      places_[lines_.vertices[p[k]]] =
          begin + (static_cast<double>(k + 1) / static_cast<double>(between + 1)) * (end - begin);
    p.insert(p.begin(), to);
    parts_[found.sliding] = std::move(p);
    put_ends(found.sliding);
    // What was a joint stays an end of lines: they may double back there.
    const auto cut = q.begin() + static_cast<std::ptrdiff_t>(found.at);
    Line beyond(cut, q.end());
    q.erase(cut + 1, q.end());
    parts_[found.other] = std::move(q);
    put_ends(found.other);
    add(std::move(beyond));
    for (std::uint32_t v = joint; at_[v].size() == 1 && !ends_[lines_.vertices[v]];) {
      const Line line = taken(at_[v].front().line);
      v = line.front() == v ? line.back() : line.front();
    }
  }

  const SheetLines& lines_;
  std::span<const char> ends_;
  std::span<const double> ball_;
  double spacing_;
  std::vector<Vec3>& places_;
  std::vector<Line> parts_;               // by numbers in lines_.vertices; what was taken is empty
  std::vector<std::vector<LineEnd>> at_;  // per vertex
  std::vector<Beside> longest_at_;        // per vertex, of what ends there; of length 0 where there is none
  std::set<Beside> longest_;              // of these
  std::vector<char> is_stale_;
  std::vector<std::uint32_t> stale_;  // whose longest has to be found again
};

}  // namespace

SheetLines zipped_lines(const SheetLines& lines, std::span<const char> ends, std::span<const double> ball,
                        double spacing, std::vector<Vec3>& places, ExecutionContext* context) {
  return Zip(lines, ends, ball, spacing, places).run(context);
}

}  // namespace affskel::core
