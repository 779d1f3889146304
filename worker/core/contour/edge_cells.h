#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/lattice/lattice_edges.h"
#include "core/lattice/solid_parts.h"

namespace affskel::core {

/// A cell of the lattice, the cube between (i, j, k) and (i+1, j+1, k+1); indices from -1.
using CellPlace = std::array<std::int64_t, 3>;

/// The cells round the lattice edges that a sheet crosses, four to an edge.  Where two parts of the solid
/// come nearer to each other than a cell, each has a cell of its own there, so that their sheets never touch.
struct EdgeCells {
  std::vector<CellPlace> place;                    ///< per cell, in lattice order
  std::vector<std::uint32_t> part;                 ///< per cell: of the solid; ascending in one place
  std::vector<std::uint32_t> begin;                ///< per cell: its first entry in `members`; one more
  std::vector<std::uint32_t> members;              ///< indices of edges, ascending by cell
  std::vector<std::array<std::uint32_t, 4>> ring;  ///< per edge: its cells, once round

  std::size_t size() const { return place.size(); }
  std::span<const std::uint32_t> edges_of(std::uint32_t cell) const {
    return {members.data() + begin[cell], members.data() + begin[cell + 1]};
  }
};

/// @param edges of this lattice, each once.
/// @throws CoreError kLimit for 2^30 edges and more.
EdgeCells edge_cells(const Lattice& lattice, const SolidParts& parts, std::span<const LatticeEdge> edges);

}  // namespace affskel::core
