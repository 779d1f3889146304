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

constexpr double kWhole = 0.99;  // of a slice

// From a place in a row on; itself where there is none.
std::size_t nearest_whole(const std::vector<char>& whole, std::size_t n) {
  for (std::size_t away = 0; away < whole.size(); ++away) {
    if (away <= n && whole[n - away]) return n - away;
    if (n + away < whole.size() && whole[n + away]) return n + away;
  }
  return n;
}

}  // namespace

std::vector<double> limb_radii(const LimbRadiiInput& input) {
  const std::size_t vertices = input.places.size();
  const auto lines = polylines(vertices, input.segments);
  std::vector<std::uint32_t> ends(vertices, 0);  // of lines
  for (const auto& line : lines)
    for (const std::uint32_t v : {line.front(), line.back()}) ++ends[v];
  const auto is_body = [&](std::uint32_t v) { return ends[v] > 2 && input.share[v] > input.slice[v]; };
  std::vector<double> radius(vertices, 0);
  for (const auto& line : lines) {
    const std::size_t count = line.size();
    const auto is_joint = [&](std::size_t n) {
      return (n == 0 || n + 1 == count) && ends[line[n]] > 2 && !is_body(line[n]);
    };
    std::vector<char> whole(count);
    bool is_hidden = true;  // all of it lies in others
    for (std::size_t n = 0; n < count; ++n) {
      const double share = input.share[line[n]];
      whole[n] = !is_joint(n) && !is_body(line[n]) && share > 0 && share >= kWhole * input.slice[line[n]];
      is_hidden &= !whole[n];
    }
    if (is_hidden) std::fill(whole.begin(), whole.end(), 1);
    // A joint has nothing: what is next to it has its share.
    const auto& share = is_hidden ? input.slice : input.share;
    std::vector<double> volume(count + 1, 0), length(count + 1, 0);  // of all before
    for (std::size_t n = 0; n < count; ++n) {
      const std::uint32_t v = line[n];
      const bool is_end = n == 0 || n + 1 == count;
      double own = is_end && ends[v] == 1 ? input.ball[v] : 0;
      if (n > 0) own += 0.5 * norm(input.places[v] - input.places[line[n - 1]]);
      if (n + 1 < count) own += 0.5 * norm(input.places[line[n + 1]] - input.places[v]);
      volume[n + 1] = volume[n] + input.volume * share[v] / (is_end ? ends[v] : 1);
      length[n + 1] = length[n] + own;
    }
    const auto radius_at = [&](std::size_t n) {
      std::size_t low = n, high = n + 1;
      while (low > 0 && n - low < kWindow && (whole[low - 1] || is_joint(low - 1))) --low;
      while (high < count && high - n <= kWindow && (whole[high] || is_joint(high))) ++high;
      return std::sqrt((volume[high] - volume[low]) / (length[high] - length[low]) / std::numbers::pi);
    };
    for (std::size_t n = 0; n < count; ++n) {
      // Where lines meet, the mean of theirs.
      const double weight = n == 0 || n + 1 == count ? ends[line[n]] : 1;
      radius[line[n]] += radius_at(nearest_whole(whole, n)) / weight;
    }
  }
  for (std::uint32_t v = 0; v < vertices; ++v)
    if (is_body(v)) radius[v] = std::cbrt(0.75 / std::numbers::pi * input.volume * input.share[v]);
  return radius;
}

}  // namespace affskel::core
