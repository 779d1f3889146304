// A speck may lie so far away that, beside the mesh's whole box, no solid has more than the least volume.
// Then the others are compared with the largest solid, provided that it has more beside its own box.
//
// A solid is no speck
// - when its volume, or the volume that one of its surfaces bounds (for skins thinner than rounding), is
//   more than kSpeckShare of the largest solid's;
// - when one of its surfaces bounds more than the least volume;
// - when its volume counts beside the box of it and those it is compared with.  That is so when the mesh is
//   large only because its specks lie far away, and there are such specks.
#include "core/solid/specks.h"

#include <algorithm>
#include <cmath>

#include "core/base/none.h"

namespace affskel::core {
namespace {

// Whether the volume can be told from rounding in a mesh with this box.
bool counts_in(const Box& box, double volume) {
  int exponent = 0;  // of the cube that would be 1 in scaled coordinates
  if (std::frexp(box.longest_side(), &exponent) == 0.5) --exponent;
  return volume > std::ldexp(kMinScaledVolume, 3 * exponent);
}

}  // namespace

std::vector<SolidSize> solid_sizes(const Solid& solid) {
  const std::vector<Vec3>& points = solid.mesh.points;
  std::vector<std::uint32_t> corner(solid.shells.size(), kNone);
  std::vector<double> shell_volume(solid.shells.size(), 0);
  std::vector<SolidSize> sizes(solid.solid_volume.size(), {{}, 0, 0, kNone});
  for (std::uint32_t t = 0; t < solid.mesh.triangles.size(); ++t) {
    const Triangle& c = solid.mesh.triangles[t];
    const std::uint32_t shell = solid.triangle_shell[t];
    if (corner[shell] == kNone) corner[shell] = c[0];
    shell_volume[shell] += six_volumes(points[corner[shell]], points[c[0]], points[c[1]], points[c[2]]) / 6;
    SolidSize& size = sizes[solid.shells[shell].solid];
    size.box.include(box_of(solid.mesh, c));
    size.first_triangle = std::min(size.first_triangle, t);
  }
  for (std::size_t s = 0; s < solid.shells.size(); ++s) {
    SolidSize& size = sizes[solid.shells[s].solid];
    const double volume = std::abs(shell_volume[s]);
    size.volume += solid.shells[s].cavity ? -volume : volume;
    size.bulk = std::max(size.bulk, volume);
  }
  return sizes;
}

std::vector<std::uint8_t> find_specks(const Solid& solid, const std::vector<double>& volumes) {
  std::vector<std::uint8_t> specks(volumes.size(), 0);
  const auto large = [](double volume) { return volume > kMinScaledVolume; };
  if (std::all_of(volumes.begin(), volumes.end(), large)) return specks;

  const std::vector<SolidSize> sizes = solid_sizes(solid);
  const SolidSize& largest = *std::ranges::max_element(sizes, {}, &SolidSize::volume);
  Box rest;
  for (std::size_t s = 0; s < sizes.size(); ++s) {
    if (large(volumes[s])) rest.include(sizes[s].box);
  }
  if (std::none_of(volumes.begin(), volumes.end(), large)) {
    if (!counts_in(largest.box, largest.volume)) return specks;
    rest = largest.box;
  }
  for (std::size_t s = 0; s < sizes.size(); ++s) {
    specks[s] = !large(volumes[s]) && !large(sizes[s].bulk) && sizes[s].bulk <= kSpeckShare * largest.volume;
  }
  const std::vector<std::uint8_t> candidates = specks;
  for (std::size_t s = 0; s < sizes.size(); ++s) {
    Box both = rest;
    both.include(sizes[s].box);
    if (specks[s] != 0 && counts_in(both, sizes[s].volume)) specks[s] = 0;
  }
  // Solids each of which counts alone, but that lie so far apart that together they do not.
  return std::count(specks.begin(), specks.end(), 1) > 0 ? specks : candidates;
}

}  // namespace affskel::core
