#include "core/curve/limb_radii.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

// Vertices on either side: slices of one step hold too few sample points to tell their thickness.
constexpr std::size_t kWindow = 4;

}  // namespace

std::vector<double> limb_radii(const LimbRadiiInput& input) {
  const std::size_t vertices = input.places.size();
  const auto lines = polylines(vertices, input.segments);
  std::vector<std::uint32_t> ends(vertices, 0);  // of lines
  for (const auto& line : lines)
    for (const std::uint32_t v : {line.front(), line.back()}) ++ends[v];
  std::vector<double> radius(vertices, 0);
  for (const auto& line : lines) {
    const std::size_t count = line.size();
    std::vector<double> volume(count + 1, 0), length(count + 1, 0);  // of all before
    for (std::size_t n = 0; n < count; ++n) {
      const std::uint32_t v = line[n];
      const bool is_end = n == 0 || n + 1 == count;
      double own = is_end && ends[v] == 1 ? input.ball[v] : 0;
      if (n > 0) own += 0.5 * norm(input.places[v] - input.places[line[n - 1]]);
      if (n + 1 < count) own += 0.5 * norm(input.places[line[n + 1]] - input.places[v]);
      volume[n + 1] = volume[n] + input.volume * input.share[v] / (is_end ? ends[v] : 1);
      length[n + 1] = length[n] + own;
    }
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t low = n - std::min(n, kWindow), high = std::min(count, n + kWindow + 1);
      const double area = (volume[high] - volume[low]) / (length[high] - length[low]);
      // Where lines meet, the mean of theirs.
      const double weight = n == 0 || n + 1 == count ? ends[line[n]] : 1;
      radius[line[n]] += std::sqrt(area / std::numbers::pi) / weight;
    }
  }
  return radius;
}

}  // namespace affskel::core
