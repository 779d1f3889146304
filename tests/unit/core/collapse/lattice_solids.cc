#include "core/collapse/lattice_solids.h"

#include <map>
#include <vector>

#include "core/base/split_mix64.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {

LatticeSolid::LatticeSolid(const Mesh& mesh, double spacing) : solid(make_solid(mesh)) {
  LatticeOptions options;
  options.spacing = spacing;
  lattice = make_lattice(solid, options);
}

Mesh random_solid(std::uint64_t seed) {
  SplitMix64 random(seed);
  const auto within = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random.next() >> 11) * 0x1p-53);
  };
  Mesh result;
  const std::uint64_t parts = 1 + random.next() % 4;
  for (std::uint64_t n = 0; n < parts; ++n) {
    Mesh part;
    switch (random.next() % 5) {
      case 0:
        part = make_sphere(within(0.5, 1), 80);
        break;
      case 1:
        part = make_box(within(0.5, 2), within(0.5, 2), within(0.5, 2));
        break;
      case 2:
        part = make_torus(within(0.7, 1.1), within(0.2, 0.4), 128);
        break;
      case 3:
        part = make_cylinder(within(0.2, 0.4), within(1, 3), 12);
        break;
      default:
        part = joined(make_sphere(1, 80), reversed(make_sphere(within(0.3, 0.7), 80)));
        break;
    }
    // Turned, so that nothing lies level with the lattice.
    part = shaken(std::move(part), 0, random.next());
    result = joined(std::move(result),
                    moved(std::move(part), {within(-0.7, 0.7), within(-0.7, 0.7), within(-0.7, 0.7)}));
  }
  return result;
}

CellMesh mesh_of_cells(const DualComplex& complex, const CellSet& cells) {
  using Cell = DualComplex::Cell;
  CellMesh result;
  // A place for every cell, so that two edges with the same ends, at both sides of a thin gap, stay two.
  std::map<Cell, std::uint32_t> number;
  cells.for_each([&](Cell cell) {
    if (DualComplex::dimension(cell) == 3) ++result.cubes;
    number.emplace(cell, static_cast<std::uint32_t>(number.size()));
  });
  cells.for_each([&](Cell cell) {
    const std::uint32_t middle = number.at(cell);
    if (DualComplex::dimension(cell) == 1)
      complex.for_each_face(cell, [&](Cell end) { result.segments.push_back({middle, number.at(end)}); });
    if (DualComplex::dimension(cell) != 2) return;
    complex.for_each_face(cell, [&](Cell edge) {
      complex.for_each_face(edge, [&](Cell end) {
        result.mesh.triangles.push_back({middle, number.at(edge), number.at(end)});
      });
    });
  });
  result.mesh.points.resize(number.size());
  return result;
}

}  // namespace affskel::core
