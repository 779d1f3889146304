#include "core/ridge/spikes.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/collapse/shortest_ways.h"
#include "core/contour/edge_cells.h"
#include "core/ridge/ridge_constants.h"
#include "core/spatial/distance_to_mesh.h"

namespace affskel::core {
namespace {

Mesh folded_triangles(const Solid& solid, const Mesh& walls) {
  std::vector<char> crosses(walls.triangles.size(), 0);
  for (const auto& crossing : solid.crossings)
    if (solid.is_fold(crossing)) crosses[crossing.first] = crosses[crossing.second] = 1;
  Mesh mesh{.points = walls.points, .triangles = {}};
  for (std::size_t t = 0; t < crosses.size(); ++t)
    if (crosses[t]) mesh.triangles.push_back(walls.triangles[t]);
  return mesh;
}

// The longest spike on a limb of that thickness, spacings.
double longest_spike(float thickness) {
  return RidgeConstants::end_spacings + RidgeConstants::end_radii * static_cast<double>(thickness);
}

double longest_spike(const SpikyLimbs& limbs) {
  return longest_spike(*std::max_element(limbs.thickness.begin(), limbs.thickness.end()));
}

}  // namespace

std::vector<char> possible_spikes(const Solid& solid, const Mesh& walls, const Lattice& lattice,
                                  const SpikyLimbs& limbs) {
  const Mesh mesh = folded_triangles(solid, walls);
  if (mesh.triangles.empty()) return {};
  const DistanceToMesh crossing(mesh);
  const bool everywhere =
      static_cast<double>(mesh.triangles.size()) >= kNoisy * static_cast<double>(walls.triangles.size());
  const double longest = std::min(kSpike * limbs.noise, longest_spike(limbs));
  std::vector<char> possible;
  possible.reserve(limbs.tips.size());
  for (const LimbTip& tip : limbs.tips) {
    const Vec3 place = places_of_vertices(lattice, {&tip.vertex, 1}).front();
    const double near = radius_about(limbs.complex, limbs.radius, tip.vertex) + limbs.noise;
    possible.push_back(tip.length <= longest && (everywhere || crossing.nearest(place) <= near));
  }
  return possible;
}

std::vector<LimbTip> limbs_without_spikes(const SpikyLimbs& limbs, const CellSet& skeleton) {
  if (limbs.tips.empty()) return {};
  std::vector<char> has_skeleton(limbs.complex.cubes(), 0);
  skeleton.for_each([&](DualComplex::Cell cell) {
    for (const auto& member : limbs.complex.star(cell)) has_skeleton[member.cube] = 1;
  });
  const double longest = longest_spike(limbs);
  std::vector<LimbTip> result;
  for (const LimbTip& tip : limbs.tips) {
    const auto stands_on = [&](std::uint32_t cube, float way) {
      const double spike = longest_spike(limbs.thickness[cube]);
      return has_skeleton[cube] != 0 && tip.length <= spike && static_cast<double>(way) <= tip.length + spike;
    };
    if (!is_near(limbs.complex, tip.vertex, static_cast<float>(tip.length + longest), stands_on))
      result.push_back(tip);
  }
  return result;
}

}  // namespace affskel::core
