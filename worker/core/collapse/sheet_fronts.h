#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/collapse/cell_sets.h"
#include "core/collapse/dual_complex.h"

namespace affskel::core {

/// When the front of a solid that is thinned at unit speed passes its medial sheets, however they lie in the lattice.
/// A collapse takes a square of what is left at a time, of a sheet as of a staircase: counted in squares a front along
/// a diagonal takes up to 1.7 times as long as it does.
class SheetFronts {
 public:
  using Cell = DualComplex::Cell;

  /// @param depth per cube: its distance to the surface, spacings.
  SheetFronts(const DualComplex& complex, std::span<const float> depth);

  /// Whether what is left of the cubes about a cell lies off the medial axis, where the front has passed already.
  bool is_passed(Cell cell, Cell coface) const;

  /// An edge has one square left: from the end of this wave on the front stands there.
  void stands_at(Cell edge) { standing_.push_back(edge); }
  /// What one wave of a collapse removes has no order.
  void end_wave();

  /// A square goes, with an edge of its that the front stands at, and has passed or not.
  /// @return when the front has crossed it, spacings; 0 where it was no sheet's.
  float cross(Cell edge, Cell square, bool passed);

  /// When what has gone of an edge's squares and cubes had, spacings.
  float reached(Cell edge);

 private:
  Vec3 slope_at(std::uint32_t cube) const;
  Vec3 sheet_normal(Cell square, std::size_t across) const;
  double crossed(Cell edge, Cell square);

  const DualComplex& complex_;
  std::span<const float> depth_;
  CellValues<float> reached_;  // per edge, by a front on a sheet; negative until it stands there
  std::vector<Cell> standing_;
};

}  // namespace affskel::core
