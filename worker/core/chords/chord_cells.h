#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/chords/chord_shocks.h"
#include "core/lattice/lattice.h"
#include "core/lattice/solid_parts.h"

namespace affskel::core {

/// A cell of the lattice, the cube between (i, j, k) and (i+1, j+1, k+1); indices from -1.
using CellPlace = std::array<std::int64_t, 3>;

/// The cells round the lattice edges of shocks, four to an edge.  Where two parts of the solid come nearer to
/// each other than a cell, each has a cell of its own there, so that their shocks never touch.
struct ChordCells {
  std::vector<CellPlace> place;                    ///< per cell, in lattice order
  std::vector<std::uint32_t> part;                 ///< per cell: of the solid; ascending in one place
  std::vector<std::uint32_t> begin;                ///< per cell: its first entry in `members`; one more
  std::vector<std::uint32_t> members;              ///< indices of shocks, ascending by cell
  std::vector<std::array<std::uint32_t, 4>> ring;  ///< per shock: its cells, once round its edge

  std::size_t size() const { return place.size(); }
  std::span<const std::uint32_t> shocks_of(std::uint32_t cell) const {
    return {members.data() + begin[cell], members.data() + begin[cell + 1]};
  }
};

/// @param shocks of this lattice.
/// @throws CoreError kLimit for 2^30 shocks and more.
ChordCells chord_cells(const Lattice& lattice, const SolidParts& parts, std::span<const ChordShock> shocks);

}  // namespace affskel::core
