#include "core/ridge/drawn_out_lines.h"

#include <algorithm>
#include <cstddef>

#include "core/base/none.h"
#include "core/base/unit.h"

namespace affskel::core {
namespace {

// Of the depth of what a line leads to: how deep it ends, how deep it lies at least, and how often it is looked.
constexpr double kEndDepth = 0.5, kLeastDepth = 0.4, kLooks = 0.125;

class DrawOut {
 public:
  explicit DrawOut(const LinesToDrawOut& lines) : in_(lines), shift_(lines.places.size()) {}

  std::vector<MovedVertex> run() {
    for (std::uint32_t v = 0; v < shift_.size(); ++v)
      if (in_.neighbours[v].size() == 1) draw_out(v);
    std::vector<MovedVertex> moved;
    for (std::uint32_t v = 0; v < shift_.size(); ++v)
      if (shift_[v] != Vec3{}) moved.push_back({v, at(v) + shift_[v]});
    return moved;
  }

 private:
  // From an end on as far as it is deep, or to where other lines or surfaces begin, with the ways along the line.
  struct Stretch {
    std::vector<std::uint32_t> line;
    std::vector<double> way;
  };

  Stretch last_stretch(std::uint32_t end, double length) const {
    Stretch stretch{{end}, {0}};
    std::uint32_t before = kNone;
    do {
      const std::uint32_t from = stretch.line.back();
      const auto next = in_.neighbours[from];
      const std::uint32_t to = next[next.size() == 2 && next[0] == before ? 1 : 0];
      stretch.line.push_back(to);
      stretch.way.push_back(stretch.way.back() + norm(at(to) - at(from)));
      before = from;
    } while (stretch.way.back() < length && in_.neighbours[stretch.line.back()].size() == 2);
    return stretch;
  }

  // A line that is shorter than its end is deep has no direction to speak of, and leads through no limb.
  void draw_out(std::uint32_t end) {
    const double depth = in_.depth(at(end));
    const auto [line, way] = last_stretch(end, depth);
    if (depth == 0 || way.back() < depth) return;
    const Vec3 along = unit(at(end) - at(line.back()));
    const double further = way_to_depth(at(end), along, depth);
    std::vector<Vec3> shifts;
    for (std::size_t n = 0; n + 1 < line.size(); ++n) {
      shifts.push_back((further * (1 - way[n] / way.back())) * along);
      if (in_.depth(at(line[n]) + shifts.back()) < kLeastDepth * depth) return;  // a line that bends too much
    }
    for (std::size_t n = 0; n < shifts.size(); ++n) shift_[line[n]] = shift_[line[n]] + shifts[n];
  }

  const Vec3& at(std::uint32_t vertex) const { return in_.places[vertex]; }

  // Between two looks the depth is taken to fall evenly: that the way does not hang on how they are rounded.
  double way_to_depth(const Vec3& from, const Vec3& along, double depth) const {
    const double step = std::min(in_.step, kLooks * depth);
    double way = 0, here = depth;
    while (way < depth) {
      const double next = in_.depth(from + (way + step) * along);
      if (next <= kEndDepth * depth) return way + step * (here - kEndDepth * depth) / (here - next);
      here = next;
      way += step;
    }
    return depth;
  }

  const LinesToDrawOut& in_;
  std::vector<Vec3> shift_;  // per vertex, of both ends of a short line
};

}  // namespace

std::vector<MovedVertex> drawn_out_lines(const LinesToDrawOut& lines) {
  return DrawOut(lines).run();
}

}  // namespace affskel::core
