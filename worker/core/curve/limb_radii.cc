#include "core/curve/limb_radii.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/base/plain_math.h"
#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

// Vertices on either side: slices of one step hold too few sample points to tell their thickness, and noise changes one
// section.
constexpr std::size_t kWindow = 4;

constexpr double kWhole = 0.99;  // of a slice
constexpr double kOpen = 1.3;    // tubes or balls: of a section that reaches into others

// From a place in a row on; itself where there is none.
std::size_t nearest_whole(const std::vector<char>& whole, std::size_t n) {
  for (std::size_t away = 0; away < whole.size(); ++away) {
    if (away <= n && whole[n - away]) return n - away;
    if (n + away < whole.size() && whole[n + away]) return n + away;
  }
  return n;
}

// Vertices about one, as far as all between are whole: [low, high).
struct Window {
  std::size_t low, high;
};

template <class IsWhole>
Window window(std::size_t n, std::size_t count, const IsWhole& is_whole) {
  Window around{n, n + 1};
  while (around.low > 0 && n - around.low < kWindow && is_whole(around.low - 1)) --around.low;
  while (around.high < count && around.high - n <= kWindow && is_whole(around.high)) ++around.high;
  return around;
}

double radius_of_disc(double area) {
  return std::sqrt(area / std::numbers::pi);
}

}  // namespace

std::vector<double> slice_radii(const LimbSlices& input) {
  const std::vector<std::uint32_t> ends = ends_of(input.places.size(), input.lines);
  std::vector<double> radius(input.places.size(), 0);
  for (const auto& line : input.lines) {
    const std::size_t count = line.size();
    std::vector<double> volume(count + 1, 0), length(count + 1, 0);  // of all before
    std::vector<char> whole(count);
    for (std::size_t n = 0; n < count; ++n) {
      const std::uint32_t v = line[n];
      const bool is_end = n == 0 || n + 1 == count;
      double own = is_end && ends[v] == 1 ? input.ball[v] : 0;
      if (n > 0) own += 0.5 * norm(input.places[v] - input.places[line[n - 1]]);
      if (n + 1 < count) own += 0.5 * norm(input.places[line[n + 1]] - input.places[v]);
      volume[n + 1] = volume[n] + input.volume * input.slice[v] / (is_end ? ends[v] : 1);
      length[n + 1] = length[n] + own;
      whole[n] = !(is_end && ends[v] > 2) && input.slice[v] > 0;
    }
    for (std::size_t n = 0; n < count; ++n) {
      const auto is_near = [&](std::size_t k) { return whole[k] || ends[line[k]] > 2; };
      const auto [low, high] = window(nearest_whole(whole, n), count, is_near);
      // Where lines meet, the mean of theirs.
      const double weight = n == 0 || n + 1 == count ? ends[line[n]] : 1;
      radius[line[n]] += radius_of_disc((volume[high] - volume[low]) / (length[high] - length[low])) / weight;
    }
  }
  return radius;
}

std::vector<double> limb_radii(const LimbRadiiInput& input) {
  const std::size_t vertices = input.share.size();
  const std::vector<std::uint32_t> ends = ends_of(vertices, input.lines);
  std::vector<double> radius(vertices, 0);
  std::vector<char> in_line(vertices, 0);
  // What is nearest to a short link may be little: the limbs beside it have the rest.
  const auto tube_at = [&](std::uint32_t v) { return std::max(input.tube[v], input.ball[v]); };
  for (const auto& line : input.lines) {
    const std::size_t count = line.size();
    for (const std::uint32_t v : line) in_line[v] = 1;
    std::vector<char> whole(count);
    const auto find_whole = [&](bool in_joints) {
      for (std::size_t n = 0; n < count; ++n) {
        const std::uint32_t v = line[n];
        whole[n] = ends[v] < 3 && (in_joints || !input.in_joint[v]) && input.share[v] > 0 &&
                   input.share[v] >= kWhole * input.slice[v] && input.area[v] > 0 &&
                   radius_of_disc(input.area[v]) < kOpen * tube_at(v);
      }
      return std::find(whole.begin(), whole.end(), 1) != whole.end();
    };
    const bool is_any = find_whole(false) || find_whole(true);
    for (std::size_t n = 0; n < count; ++n) {
      const auto [low, high] =
          window(nearest_whole(whole, n), count, [&](std::size_t k) { return whole[k]; });
      double area = 0;
      for (std::size_t k = low; k < high; ++k) area += input.area[line[k]];
      const double weight = n == 0 || n + 1 == count ? ends[line[n]] : 1;  // as above
      radius[line[n]] +=
          (is_any ? radius_of_disc(area / static_cast<double>(high - low)) : tube_at(line[n])) / weight;
    }
  }
  for (std::uint32_t v = 0; v < vertices; ++v)
    if (input.share[v] > 0 && (!in_line[v] || (ends[v] > 2 && input.share[v] > input.slice[v])))
      radius[v] = cube_root(0.75 / std::numbers::pi * input.volume * input.share[v]);
  return radius;
}

}  // namespace affskel::core
