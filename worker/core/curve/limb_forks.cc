#include "core/curve/limb_forks.h"

#include <algorithm>

namespace affskel::core {
namespace {

constexpr int kHalves = 5;  // of a step: how exactly a fork is found

}  // namespace

double ahead(const Vec3& way, const Vec3& direction) {
  const double along = dot(way, direction);
  return std::max(0.0, along * along / dot(way, way) - 0.25);
}

std::vector<std::vector<LimbFork>> limb_forks(std::span<const Vec3> places,
                                              std::span<const std::vector<std::uint32_t>> lines,
                                              const LimbSections& sections, double step,
                                              std::span<const char> left_out) {
  const std::vector<std::vector<LineEnd>> ends = line_ends(places.size(), lines);
  std::vector<std::vector<LimbFork>> forks(places.size());
  for (std::size_t v = 0; v < places.size(); ++v) {
    if (ends[v].size() < 3 || (!left_out.empty() && left_out[v])) continue;
    const auto at = [&](const LineEnd& end, double way) {
      return place_along(places, lines[end.line], end.back, way);
    };
    std::vector<double> lengths;
    for (const LineEnd& end : ends[v]) lengths.push_back(length_of(places, lines[end.line]));
    for (std::size_t a = 0; a < lengths.size(); ++a)
      for (std::size_t b = a + 1; b < lengths.size(); ++b) {
        const bool is_loop = ends[v][a].line == ends[v][b].line;
        const double most = (is_loop ? 0.5 : 1) * std::min(lengths[a], lengths[b]);
        const auto parted = [&](double way) {
          return sections.parted(at(ends[v][a], way), at(ends[v][b], way));
        };
        double sees = 0, way = step;
        while (way < most && !parted(way)) {
          sees = way;
          way += step;
        }
        if (way >= most) continue;
        for (int half = 0; half < kHalves; ++half) {
          const double middle = 0.5 * (sees + way);
          (parted(middle) ? way : sees) = middle;
        }
        forks[v].push_back({{ends[v][a], ends[v][b]}, *parted(way)});
      }
  }
  return forks;
}

std::size_t before_forks(std::span<const Vec3> places, std::span<const std::vector<std::uint32_t>> lines,
                         std::span<const LimbFork> forks, const LineEnd& limb) {
  const auto& line = lines[limb.line];
  const auto at = [&](std::size_t n) { return places[point_from(limb.back, line, n)]; };
  std::size_t count = 0;
  const auto is_ahead = [&](const LimbFork& fork) {
    return (fork.limbs[0] == limb || fork.limbs[1] == limb) &&
           dot(fork.place - at(count), at(count + 1) - at(count)) > 0;
  };
  while (count + 1 < line.size() && std::any_of(forks.begin(), forks.end(), is_ahead)) ++count;
  return count;
}

}  // namespace affskel::core
