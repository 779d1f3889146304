#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/base/none.h"
#include "core/collapse/dual_complex.h"

namespace affskel::core {

/// A value for each cell of one dimension, lines or points: in arrays where its name is the usual one.
template <class Value>
class CellValues {
 public:
  CellValues(const DualComplex& complex, int dimension, Value none)
      : per_cube_(dimension == 0 ? 1 : 3), none_(none), usual_(per_cube_ * complex.cubes(), none) {}

  Value& operator[](DualComplex::Cell cell) {
    const std::uint32_t place = DualComplex::place_of(cell);
    const std::size_t first = per_cube_ * DualComplex::cube_of(cell);
    for (std::size_t n = 0; n < 3; ++n)
      if (place == DualComplex::kUpperVertex - (per_cube_ == 1 ? 0 : DualComplex::kWeight[n]))
        return usual_[first + n];
    return others_.try_emplace(cell, none_).first->second;
  }

 private:
  std::size_t per_cube_;
  Value none_;
  std::vector<Value> usual_;
  std::unordered_map<DualComplex::Cell, Value> others_;
};

/// A byte for each cell, by its own name, first 0.  Cells at no lower end of a cube, which are its own, come first; few
/// groups of cubes own others, and have room for these behind them.
class CellBytes {
 public:
  explicit CellBytes(const DualComplex& complex) {
    std::size_t end = kUpper * std::size_t{complex.cubes()};
    for (std::uint32_t first = 0; first < complex.cubes(); first += kGroup) {
      std::uint32_t own = 0;
      for (std::uint32_t cube = first; cube < std::min(first + kGroup, complex.cubes()); ++cube)
        own |= complex.own_places(cube);
      others_.push_back(end);
      if ((own & ~DualComplex::kUpperPlaces) != 0) end += kGroup * kOther;
    }
    bytes_.assign(end, 0);
  }

  std::uint8_t& operator[](DualComplex::Cell cell) { return bytes_[index(cell)]; }
  std::uint8_t operator[](DualComplex::Cell cell) const { return bytes_[index(cell)]; }

 private:
  static constexpr std::uint32_t kGroup = 4;  // cubes
  static constexpr std::uint32_t kUpper = 8;  // places of a cube that are at no lower end
  static constexpr std::uint32_t kOther = 27 - kUpper;

  // Of each place: those at no lower end first.
  static constexpr std::array<std::uint8_t, 27> kSlot = [] {
    std::array<std::uint8_t, 27> result{};
    std::uint8_t upper = 0, other = kUpper;
    for (std::uint32_t place = 0; place < 27; ++place)
      result[place] = (DualComplex::kUpperPlaces >> place & 1U) != 0 ? upper++ : other++;
    return result;
  }();

  std::size_t index(DualComplex::Cell cell) const {
    const std::uint32_t cube = DualComplex::cube_of(cell), slot = kSlot[DualComplex::place_of(cell)];
    if (slot < kUpper) return kUpper * std::size_t{cube} + slot;
    return others_[cube / kGroup] + kOther * (cube % kGroup) + (slot - kUpper);
  }

  std::vector<std::size_t> others_;  // where those of a group begin
  std::vector<std::uint8_t> bytes_;
};

/// Cells of a complex.
class CellSet {
 public:
  explicit CellSet(const DualComplex& complex) : bits_(complex.cubes(), 0) {}

  bool has(DualComplex::Cell cell) const {
    return (bits_[DualComplex::cube_of(cell)] >> DualComplex::place_of(cell) & 1U) != 0;
  }
  void insert(DualComplex::Cell cell) {
    bits_[DualComplex::cube_of(cell)] |= 1U << DualComplex::place_of(cell);
  }

  /// Leaves a cell out, or all cells named by a cube.
  void erase(DualComplex::Cell cell) {
    bits_[DualComplex::cube_of(cell)] &= ~(1U << DualComplex::place_of(cell));
  }
  void clear(std::uint32_t cube) { bits_[cube] = 0; }

  /// Calls visit(cell) for every one, by cube, then by place.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::uint32_t cube = 0; cube < bits_.size(); ++cube) {
      for (std::uint32_t left = bits_[cube]; left != 0; left &= left - 1)
        visit(DualComplex::name(cube, static_cast<std::uint32_t>(std::countr_zero(left))));
    }
  }

 private:
  std::vector<std::uint32_t> bits_;  // per cube, by place
};

/// Whether none of a cell's cofaces is among some cells.
bool is_bare(const DualComplex& complex, DualComplex::Cell cell, const CellSet& cells);

/// Adds a cell and all cells in its boundary.
void insert_closed(const DualComplex& complex, DualComplex::Cell cell, CellSet& set);

}  // namespace affskel::core
