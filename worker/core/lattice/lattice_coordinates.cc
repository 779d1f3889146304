#include "core/lattice/lattice_coordinates.h"

namespace affskel::core {

std::vector<LatticePlace> lattice_places(const Lattice& lattice, std::span<const std::uint32_t> points) {
  std::vector<LatticePlace> places;
  places.reserve(points.size());
  auto run = lattice.axis[2].runs.begin();
  for (const std::uint32_t point : points) {
    while (point - run->first >= run->length) ++run;
    places.push_back({run->start[0], run->start[1], run->start[2] + (point - run->first)});
  }
  return places;
}

}  // namespace affskel::core
