#include "core/lattice/lattice_coordinates.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace affskel::core {

const LatticeRun& run_of(const Lattice& lattice, std::uint32_t point) {
  const std::vector<LatticeRun>& runs = lattice.axis[2].runs;
  return *std::prev(std::upper_bound(runs.begin(), runs.end(), point,
                                     [](std::uint32_t p, const LatticeRun& run) { return p < run.first; }));
}

bool is_sample_point(const Lattice& lattice, const Vec3& indices) {
  const std::array<std::int64_t, 3> place{std::llround(indices.x), std::llround(indices.y),
                                          std::llround(indices.z)};
  const std::vector<LatticeRun>& runs = lattice.axis[2].runs;
  const auto is_before = [](const std::array<std::int64_t, 3>& at, const LatticeRun& run) {
    return std::lexicographical_compare(at.begin(), at.end(), run.start.begin(), run.start.end());
  };
  const auto after = std::upper_bound(runs.begin(), runs.end(), place, is_before);
  if (after == runs.begin()) return false;
  const LatticeRun& run = *std::prev(after);
  return run.start[0] == place[0] && run.start[1] == place[1] &&
         place[2] < std::int64_t{run.start[2]} + run.length;
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
