#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/groups.h"
#include "core/collapse/dual_complex.h"
#include "core/lattice/lattice_edges.h"
#include "core/lattice/solid_parts.h"

namespace affskel::core {

/// A cell of the lattice, the cube between (i, j, k) and (i+1, j+1, k+1); indices from -1.
using CellPlace = std::array<std::int64_t, 3>;

/// The cells round the lattice edges that a sheet crosses, four to an edge.  Where the solid comes nearer to
/// itself than a cell, each of its sides has a cell of its own there (see DualComplex), so that sheets never
/// touch across a gap.
struct EdgeCells {
  std::vector<DualComplex::Cell> vertex;           ///< per cell: the vertex dual to it; ascending
  std::vector<CellPlace> place;                    ///< per cell
  std::vector<char> whole;                         ///< per cell: all eight corners hang together round it
  std::vector<std::uint32_t> part;                 ///< per cell: of the solid
  Groups<std::uint32_t> edges;                     ///< per cell: indices of edges, ascending
  std::vector<std::array<std::uint32_t, 4>> ring;  ///< per edge: its cells, once round

  std::size_t size() const { return place.size(); }
};

/// @param complex, parts of this lattice.
/// @param edges of this lattice, each once, within the solid (see for_each_edge).
/// @throws CoreError kLimit for 2^30 edges and more.
EdgeCells edge_cells(const Lattice& lattice, const DualComplex& complex, const SolidParts& parts,
                     std::span<const LatticeEdge> edges);

/// The vertices round a square, once round.
std::array<DualComplex::Cell, 4> vertices_round(const DualComplex& complex, DualComplex::Cell square);

/// The cells that vertices of the complex are dual to.
std::vector<CellPlace> cells_of_vertices(const Lattice& lattice, std::span<const DualComplex::Cell> vertices);

/// The middle of a cell, real lattice indices.
inline Vec3 middle_of(const CellPlace& cell) {
  return vector_of(cell) + Vec3{0.5, 0.5, 0.5};
}

/// Of the cells that vertices of the complex are dual to.
std::vector<Vec3> places_of_vertices(const Lattice& lattice, std::span<const DualComplex::Cell> vertices);

}  // namespace affskel::core
