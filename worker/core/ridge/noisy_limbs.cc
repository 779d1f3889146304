#include "core/ridge/noisy_limbs.h"

#include <cstddef>

#include "core/contour/edge_cells.h"
#include "core/spatial/distance_to_mesh.h"

namespace affskel::core {
namespace {

Mesh crossing_triangles(const Solid& solid, const Mesh& walls) {
  std::vector<char> crosses(walls.triangles.size(), 0);
  for (const auto& [a, b] : solid.crossings) crosses[a] = crosses[b] = 1;
  Mesh mesh{.points = walls.points, .triangles = {}};
  for (std::size_t t = 0; t < crosses.size(); ++t)
    if (crosses[t]) mesh.triangles.push_back(walls.triangles[t]);
  return mesh;
}

}  // namespace

std::vector<char> noisy_limbs(const Solid& solid, const Mesh& walls, const Lattice& lattice,
                              const DualComplex& complex, std::span<const float> radius,
                              std::span<const LimbTip> limbs) {
  if (solid.crossings.empty()) return {};
  const Mesh mesh = crossing_triangles(solid, walls);
  const DistanceToMesh crossing(mesh);
  std::vector<char> noisy;
  noisy.reserve(limbs.size());
  for (const LimbTip& tip : limbs) {
    const Vec3 place = middle_of(cells_of_vertices(lattice, {&tip.vertex, 1}).front());
    noisy.push_back(crossing.nearest(place) <= radius_about(complex, radius, tip.vertex) + 1);
  }
  return noisy;
}

}  // namespace affskel::core
