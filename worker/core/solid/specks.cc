#include "core/solid/specks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/mesh/box_tree.h"

namespace affskel::core {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Box kNothing = {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

// The cube of the length that is 1 in the inner coordinates of a mesh with this box, in those at hand.
double inner_unit_cubed(const Box& box) {
  const double side =
      std::max({box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2]});
  return std::ldexp(1.0, 3 * static_cast<int>(std::ceil(std::log2(side))));
}

std::vector<Box> boxes_of_solids(const Solid& solid, std::size_t count) {
  std::vector<Box> boxes(count, kNothing);
  for (std::size_t t = 0; t < solid.mesh.triangles.size(); ++t) {
    boxes[solid.shells[solid.triangle_shell[t]].solid].include(box_of(solid.mesh, solid.mesh.triangles[t]));
  }
  return boxes;
}

}  // namespace

std::vector<std::uint8_t> find_specks(const Solid& solid, const std::vector<double>& volumes) {
  std::vector<std::uint8_t> specks(volumes.size(), 0);
  const auto large = [](double volume) { return volume > kLeastInnerVolume; };
  const auto larger = std::count_if(volumes.begin(), volumes.end(), large);
  if (larger == 0 || larger == static_cast<std::ptrdiff_t>(volumes.size())) return specks;

  for (std::size_t s = 0; s < volumes.size(); ++s) specks[s] = large(volumes[s]) ? 0 : 1;
  for (const Shell& shell : solid.shells) {
    if (large(std::abs(shell.volume))) specks[shell.solid] = 0;
  }
  const std::vector<std::uint8_t> candidates = specks;
  const std::vector<Box> boxes = boxes_of_solids(solid, volumes.size());
  Box rest = kNothing;
  for (std::size_t s = 0; s < volumes.size(); ++s) {
    if (large(volumes[s])) rest.include(boxes[s]);
  }
  for (std::size_t s = 0; s < volumes.size(); ++s) {
    if (specks[s] == 0) continue;
    Box both = rest;
    both.include(boxes[s]);
    if (volumes[s] > kLeastInnerVolume * inner_unit_cubed(both)) specks[s] = 0;
  }
  // Solids each of which counts alone, but that lie so far apart that together they do not.
  return std::count(specks.begin(), specks.end(), 1) > 0 ? specks : candidates;
}

}  // namespace affskel::core
