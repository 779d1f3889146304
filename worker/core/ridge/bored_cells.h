#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/collapse/dual_complex.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// A solid whose surface noise makes cross itself.
struct NoisySolid {
  const Lattice& lattice;
  const DualComplex& complex;
  std::span<const float> radius;     ///< per sample point: distance to the surface, spacings
  std::span<const float> thickness;  ///< per sample point, spacings: see section_radii()
  std::uint64_t handles = 0;         ///< of its surface
};

/// Cells that open what noise has bored.  Noise that makes a surface cross itself bores tunnels and voids through limbs, a
/// hundred in a body of 5000 triangles at 1 % of the diagonal; the solid is taken to have those of its surface alone.
/// Where there are membranes about voids, of each the square nearest to the surface.  Else, of the shortest loops, as many
/// as there are more than handles, of each that lies within kBored times the limb's thickness at one of its places the
/// edge nearest to the surface; loops between limbs that pass through each other stay.  Loops that share places take
/// turns: they are for the next call.
/// @param graph collapsed as far as it can be.
/// @param keep cells that may not be among them; null: all may.
/// @return none when there are no such, or more than kMostBored loops: the lattice resolves no solid at all.
/// @throws CoreError kCancelled when the context asks to stop.
std::vector<DualComplex::Cell> bored_cells(const NoisySolid& solid, const CellSet& graph,
                                           const CellSet* keep = nullptr,
                                           ExecutionContext* context = nullptr);

inline constexpr double kBored = 2;
inline constexpr std::size_t kMostBored = 512;

}  // namespace affskel::core
