#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace affskel::client {

/// A point of the sample grid: sample (i, j) has its centre at (i + 0.5, j + 0.5), y points down.
struct ScreenPoint {
  double x = 0;
  double y = 0;
};

namespace raster_detail {

inline constexpr std::int64_t kSub = 256;  // vertices snap to 1/256 sample, so that edges are exact integers

struct Fixed {
  std::int64_t x, y;
};

inline Fixed snap(ScreenPoint p) {
  // Far outside the picture nothing is exact any more, but nothing overflows either.
  const auto fix = [](double v) { return std::llround(std::clamp(v, -1e6, 1e6) * double(kSub)); };
  return {fix(p.x), fix(p.y)};
}

inline std::int64_t edge(Fixed a, Fixed b, Fixed p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

// Samples exactly on an edge belong to one of its two triangles: the one that has it as a top or left edge.
inline bool owns_edge(Fixed a, Fixed b) {
  return (a.y == b.y && b.x > a.x) || b.y < a.y;
}

}  // namespace raster_detail

/// Rows of samples, from the first to before the end.
struct SampleRows {
  int first = 0;
  int end = 0;
};

/// Calls visit(i, j, w0, w1, w2) for every sample in `width` columns and the rows whose centre the triangle
/// covers, w = barycentric weights of the corners.  Triangles that share an edge (the same two points) cover
/// each sample along it exactly once.  Either orientation is drawn.
template <typename Visit>
void for_each_sample(const std::array<ScreenPoint, 3>& corners, int width, SampleRows rows, Visit&& visit) {
  using namespace raster_detail;
  const auto [top, bottom] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
  if (bottom < rows.first || top > rows.end) return;
  std::array<Fixed, 3> p = {snap(corners[0]), snap(corners[1]), snap(corners[2])};
  std::int64_t area = edge(p[0], p[1], p[2]);
  if (area == 0) return;
  const bool flipped = area < 0;
  if (flipped) {
    std::swap(p[1], p[2]);
    area = -area;
  }
  const auto first = [](std::int64_t low, int least) {
    return std::max<std::int64_t>(least, (low - kSub / 2) / kSub);
  };
  const auto last = [](std::int64_t high, int end) { return std::min<std::int64_t>(end - 1, high / kSub); };
  const auto [x_low, x_high] = std::minmax({p[0].x, p[1].x, p[2].x});
  const auto [y_low, y_high] = std::minmax({p[0].y, p[1].y, p[2].y});
  std::array<std::int64_t, 3> bias{};  // an edge's own samples count from 0, others' from 1
  for (std::size_t e = 0; e < 3; ++e) bias[e] = owns_edge(p[(e + 1) % 3], p[(e + 2) % 3]) ? 0 : 1;
  for (std::int64_t j = first(y_low, rows.first); j <= last(y_high, rows.end); ++j) {
    for (std::int64_t i = first(x_low, 0); i <= last(x_high, width); ++i) {
      const Fixed centre{i * kSub + kSub / 2, j * kSub + kSub / 2};
      const std::int64_t w0 = edge(p[1], p[2], centre);
      const std::int64_t w1 = edge(p[2], p[0], centre);
      const std::int64_t w2 = edge(p[0], p[1], centre);
      if (w0 < bias[0] || w1 < bias[1] || w2 < bias[2]) continue;
      const double scale = 1 / double(area);
      visit(static_cast<int>(i), static_cast<int>(j), double(w0) * scale, double(flipped ? w2 : w1) * scale,
            double(flipped ? w1 : w2) * scale);
    }
  }
}

}  // namespace affskel::client
