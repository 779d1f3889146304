#include "core/lattice/lattice_coordinates.h"

#include <algorithm>
#include <iterator>

namespace affskel::core {

const LatticeRun& run_of(const Lattice& lattice, std::uint32_t point) {
  const std::vector<LatticeRun>& runs = lattice.axis[2].runs;
  return *std::prev(std::upper_bound(runs.begin(), runs.end(), point,
                                     [](std::uint32_t p, const LatticeRun& run) { return p < run.first; }));
}

std::vector<LatticePlace> lattice_places(const Lattice& lattice, std::span<const std::uint32_t> points) {
  std::vector<LatticePlace> places;
  places.reserve(points.size());
  const LatticeRun* run = nullptr;
  for (const std::uint32_t point : points) {
    if (run == nullptr || point - run->first >= run->length) run = &run_of(lattice, point);
    places.push_back({run->start[0], run->start[1], run->start[2] + (point - run->first)});
  }
  return places;
}

Mesh surface_in_lattice(const Solid& solid, const Lattice& lattice) {
  const LatticeIndices indices(lattice);
  Mesh surface = solid.mesh;
  for (Vec3& place : surface.points) place = indices(place);
  return surface;
}

}  // namespace affskel::core
