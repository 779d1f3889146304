#include "core/mesh/polylines.h"

#include <algorithm>

#include "core/base/groups.h"

namespace affskel::core {
namespace {

class Chainer {
 public:
  Chainer(std::size_t points, std::span<const Segment> segments)
      : segments_(segments), at_(holders(points, segments)), used_(segments.size(), false) {}

  std::vector<std::vector<std::uint32_t>> run() {
    for (std::uint32_t s = 0; s < segments_.size(); ++s) {
      if (!used_[s]) lines_.push_back(line_through(s));
    }
    return std::move(lines_);
  }

 private:
  bool is_within(std::uint32_t point) const { return at_[point].size() == 2; }

  // Goes on from the last point of the line as far as there is one way.
  void extend(std::vector<std::uint32_t>& line) {
    while (is_within(line.back())) {
      const std::uint32_t point = line.back();
      const std::uint32_t segment = used_[at_[point][0]] ? at_[point][1] : at_[point][0];
      if (used_[segment]) return;  // closed
      used_[segment] = true;
      line.push_back(segments_[segment][0] == point ? segments_[segment][1] : segments_[segment][0]);
    }
  }

  std::vector<std::uint32_t> line_through(std::uint32_t segment) {
    used_[segment] = true;
    std::vector<std::uint32_t> line = {segments_[segment][1], segments_[segment][0]};
    extend(line);
    std::reverse(line.begin(), line.end());
    if (line.front() != line.back()) {
      extend(line);
    } else if (is_within(line.front())) {
      line.pop_back();
      std::rotate(line.begin(), std::min_element(line.begin(), line.end()), line.end());
      line.push_back(line.front());
    }
    return line;
  }

  std::span<const Segment> segments_;
  Groups<std::uint32_t> at_;  // per point its segments
  std::vector<bool> used_;
  std::vector<std::vector<std::uint32_t>> lines_;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> polylines(std::size_t points, std::span<const Segment> segments) {
  return Chainer(points, segments).run();
}

std::vector<std::uint32_t> ends_of(std::size_t points, std::span<const std::vector<std::uint32_t>> lines) {
  std::vector<std::uint32_t> ends(points, 0);
  for (const auto& line : lines)
    for (const std::uint32_t point : {line.front(), line.back()}) ++ends[point];
  return ends;
}

std::vector<std::vector<LineEnd>> line_ends(std::size_t points,
                                            std::span<const std::vector<std::uint32_t>> lines) {
  std::vector<std::vector<LineEnd>> ends(points);
  for (std::uint32_t n = 0; n < lines.size(); ++n)
    for (const bool back : {false, true}) ends[point_from(back, lines[n], 0)].push_back({n, back});
  return ends;
}

Vec3 place_along(std::span<const Vec3> places, std::span<const std::uint32_t> line, bool back, double way) {
  const auto at = [&](std::size_t n) { return places[point_from(back, line, n)]; };
  for (std::size_t n = 1; n < line.size(); ++n) {
    const double length = norm(at(n) - at(n - 1));
    if (way <= length && length > 0) return at(n - 1) + (way / length) * (at(n) - at(n - 1));
    way -= length;
  }
  return at(line.size() - 1);
}

double length_of(std::span<const Vec3> places, std::span<const std::uint32_t> line) {
  double length = 0;
  for (std::size_t n = 1; n < line.size(); ++n) length += norm(places[line[n]] - places[line[n - 1]]);
  return length;
}

}  // namespace affskel::core
