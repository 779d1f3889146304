#pragma once

#include <cstdint>

#include "core/collapse/cell_sets.h"
#include "core/collapse/dual_complex.h"
#include "core/lattice/lattice.h"
#include "core/mesh/mesh.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// A solid and its sample points, upright, for the tests of complexes.
struct LatticeSolid {
  Solid solid;
  Lattice lattice;
  LatticeSolid(const Mesh& mesh, double spacing);
};

/// A union of balls, boxes, tori and bars that pass through each other, some with a cavity, about 3 across.
Mesh random_solid(std::uint64_t seed);

/// Cells that are closed under taking boundaries as triangles and segments over one numbering.
struct CellMesh {
  Mesh mesh;  ///< places in no coordinates: they tell nothing
  std::vector<Segment> segments;
  std::uint64_t cubes = 0;  ///< left out
};
CellMesh mesh_of_cells(const DualComplex& complex, const CellSet& cells);

}  // namespace affskel::core
