#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/collapse/dual_complex.h"
#include "core/lattice/lattice.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/solid/solid.h"
#include "core/solid/solid_windings.h"

namespace affskel::core {

/// How lines of a skeleton wind round the tunnels of a solid, see SolidWindings.  A straight segment between two of its
/// vertices may cut a corner and leave the solid; so the ways are taken along lattice edges within it, from the sample
/// point of one vertex to that of the other.  Keeps references to lattice and complex.
class LatticeWindings {
 public:
  /// @param points sample points next to the vertices; see SheetVertex::point.
  LatticeWindings(const Solid& solid, const Lattice& lattice, const DualComplex& complex,
                  std::vector<std::uint32_t> points);

  std::size_t loops() const { return windings_.size(); }

  /// Of the shortest way between the sample points of two vertices that are neighbours.
  std::vector<double> between(std::uint32_t from, std::uint32_t to) const;

 private:
  struct Step {
    std::uint32_t cube = 0, before = 0;  // number of the step before
    LatticePlace place{};
  };

  std::vector<Step> search(std::uint32_t from, std::uint32_t target) const;

  const Lattice& lattice_;
  const DualComplex& complex_;
  SolidWindings windings_;
  std::vector<std::uint32_t> points_;
  std::vector<LatticePlace> places_;  // of them
};

}  // namespace affskel::core
