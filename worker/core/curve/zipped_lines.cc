#include "core/curve/zipped_lines.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

using Line = std::vector<std::uint32_t>;

// A line beside another, both from the same joint on.
struct Beside {
  std::size_t sliding = 0, other = 0;  // lines
  bool sliding_back = false, other_back = false;
  std::size_t leaves = 0,
              at = 0;  // the last vertex of the one that is beside the other, and which of that it is beside
  double length = 0;
};

class Zip {
 public:
  Zip(const SheetLines& lines, std::span<const char> ends, std::span<const double> ball, double spacing,
      std::vector<Vec3>& places)
      : lines_(lines), ends_(ends), ball_(ball), spacing_(spacing), places_(places) {
    parts_ = polylines(lines.vertices.size(), lines.segments);
    count_degrees();
  }

  SheetLines run() {
    // Each slide leaves less that runs side by side; the bound is for what nobody has thought of.
    for (std::size_t n = 4 * parts_.size(); n > 0; --n) {
      const Beside found = longest();
      if (found.length == 0) break;
      slide(found);
    }
    return drawn();
  }

 private:
  const Vec3& place(std::uint32_t v) const { return places_[lines_.vertices[v]]; }
  double ball(std::uint32_t v) const { return ball_[lines_.vertices[v]]; }
  double distance(std::uint32_t a, std::uint32_t b) const { return norm(place(a) - place(b)); }

  void count_degrees() {
    degree_.assign(lines_.vertices.size(), 0);
    for (const Segment& segment : segments())
      for (const std::uint32_t v : segment) ++degree_[v];
  }

  std::vector<Segment> segments() const {
    std::vector<Segment> result;
    for (const Line& line : parts_)
      for (std::size_t k = 1; k < line.size(); ++k)
        result.push_back({std::min(line[k - 1], line[k]), std::max(line[k - 1], line[k])});
    std::sort(result.begin(), result.end());
    return result;
  }

  static Line turned(const Line& line, bool back) { return back ? Line(line.rbegin(), line.rend()) : line; }

  Beside longest() const {
    Beside best;
    for (std::size_t a = 0; a < parts_.size(); ++a) {
      for (std::size_t b = 0; b < parts_.size(); ++b) {
        if (a == b) continue;
        for (const bool a_back : {false, true}) {
          for (const bool b_back : {false, true}) {
            const Line p = turned(parts_[a], a_back), q = turned(parts_[b], b_back);
            if (p.front() != q.front() || p.size() < 3 || p.front() == p.back() || q.front() == q.back())
              continue;
            Beside found = beside(p, q);
            if (!(found.length > best.length)) continue;
            found.sliding = a;
            found.other = b;
            found.sliding_back = a_back;
            found.other_back = b_back;
            best = found;
          }
        }
      }
    }
    return best;
  }

  // Of length 0 where p does not leave the ball of the joint beside q, or has the greater balls.
  Beside beside(const Line& p, const Line& q) const {
    Beside found;
    double more = 0, length = 0;
    for (std::size_t k = 1, j = 0; k + 1 < p.size(); ++k) {
      while (j + 2 < q.size() && distance(p[k], q[j + 1]) <= distance(p[k], q[j])) ++j;
      if (distance(p[k], q[j]) > std::min(ball(p[k]), ball(q[j]))) break;
      length += distance(p[k - 1], p[k]);
      more += ball(q[j]) - ball(p[k]);
      if (j == 0 || (degree_[p[0]] > 2 && distance(p[k], p[0]) <= ball(p[0]))) continue;
      found.leaves = k;
      found.at = j;
      found.length = length;
    }
    const bool is_other = more > 0 || (more == 0 && p[1] > q[1]);
    return is_other ? found : Beside{};
  }

  void slide(const Beside& found) {
    Line p = turned(parts_[found.sliding], found.sliding_back);
    const Line q = turned(parts_[found.other], found.other_back);
    const std::uint32_t to = q[found.at], from = p[found.leaves];
    const auto between = std::min(found.leaves - 1, static_cast<std::size_t>(distance(to, from) / spacing_));
    const Vec3 begin = place(to), end = place(from);
    p.erase(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(found.leaves - between));
    for (std::size_t k = 0; k < between; ++k)
      places_[lines_.vertices[p[k]]] =
          begin + (static_cast<double>(k + 1) / static_cast<double>(between + 1)) * (end - begin);
    p.insert(p.begin(), to);
    parts_[found.sliding] = std::move(p);
    // What was a joint stays an end of lines: they may double back there.
    const auto cut = q.begin() + static_cast<std::ptrdiff_t>(found.at);
    parts_[found.other] = Line(q.begin(), cut + 1);
    parts_.emplace_back(cut, q.end());
    count_degrees();
    for (std::uint32_t v = q.front(); degree_[v] == 1 && !ends_[lines_.vertices[v]];) v = without_end(v);
  }

  // @returns the vertex that is the end now.
  std::uint32_t without_end(std::uint32_t end) {
    const auto line = std::find_if(parts_.begin(), parts_.end(), [&](const Line& part) {
      return part.front() == end || part.back() == end;
    });
    const std::uint32_t next = line->front() == end ? line->back() : line->front();
    parts_.erase(line);
    count_degrees();
    return next;
  }

  SheetLines drawn() const {
    SheetLines result;
    result.opened = lines_.opened;
    std::vector<std::uint32_t> number(lines_.vertices.size(), 0);
    std::vector<char> was_alone(number.size(), 1);
    for (const Segment& segment : lines_.segments)
      for (const std::uint32_t v : segment) was_alone[v] = 0;
    for (std::uint32_t v = 0; v < number.size(); ++v) {
      if (degree_[v] == 0 && !was_alone[v]) continue;
      number[v] = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.push_back(lines_.vertices[v]);
    }
    for (const auto& [a, b] : segments()) result.segments.push_back({number[a], number[b]});
    return result;
  }

  const SheetLines& lines_;
  std::span<const char> ends_;
  std::span<const double> ball_;
  double spacing_;
  std::vector<Vec3>& places_;
  std::vector<Line> parts_;  // by numbers in lines_.vertices
  std::vector<std::uint32_t> degree_;
};

}  // namespace

SheetLines zipped_lines(const SheetLines& lines, std::span<const char> ends, std::span<const double> ball,
                        double spacing, std::vector<Vec3>& places) {
  return Zip(lines, ends, ball, spacing, places).run();
}

}  // namespace affskel::core
