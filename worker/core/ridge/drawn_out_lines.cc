#include "core/ridge/drawn_out_lines.h"

#include <algorithm>
#include <cstddef>

#include "core/base/none.h"
#include "core/base/unit.h"

namespace affskel::core {
namespace {

constexpr double kEndDepth = 0.5;  // how deep a line ends, of the depth of what it leads to

class DrawOut {
 public:
  explicit DrawOut(const LinesToDrawOut& lines) : in_(lines), places_(lines.places) {}

  std::vector<MovedVertex> run() {
    for (std::uint32_t v = 0; v < places_.size(); ++v)
      if (in_.neighbours[v].size() == 1) draw_out(v);
    std::vector<MovedVertex> moved;
    for (std::uint32_t v = 0; v < places_.size(); ++v)
      if (places_[v] != in_.places[v]) moved.push_back({v, places_[v]});
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
      const std::uint32_t at = stretch.line.back();
      const auto next = in_.neighbours[at];
      const std::uint32_t to = next[next.size() == 2 && next[0] == before ? 1 : 0];
      stretch.line.push_back(to);
      stretch.way.push_back(stretch.way.back() + norm(places_[to] - places_[at]));
      before = at;
    } while (stretch.way.back() < length && in_.neighbours[stretch.line.back()].size() == 2);
    return stretch;
  }

  void draw_out(std::uint32_t end) {
    const double depth = in_.depth(places_[end]);
    const auto [line, way] = last_stretch(end, depth);
    const Vec3 along = unit(places_[end] - places_[line.back()]);
    if (along == Vec3{}) return;
    const double further = way_to_depth(places_[end], along, depth);
    for (std::size_t n = 0; n + 1 < line.size(); ++n)
      places_[line[n]] = places_[line[n]] + (further * (1 - way[n] / way.back())) * along;
  }

  // Between two looks the depth is taken to fall evenly: that the way does not hang on how they are rounded.
  double way_to_depth(const Vec3& from, const Vec3& along, double depth) const {
    double way = 0, here = depth;
    while (way < depth) {
      const double next = in_.depth(from + (way + in_.step) * along);
      if (next <= kEndDepth * depth) return way + in_.step * (here - kEndDepth * depth) / (here - next);
      here = next;
      way += in_.step;
    }
    return depth;
  }

  const LinesToDrawOut& in_;
  std::vector<Vec3> places_;
};

}  // namespace

std::vector<MovedVertex> drawn_out_lines(const LinesToDrawOut& lines) {
  return DrawOut(lines).run();
}

}  // namespace affskel::core
