#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/collapse/dual_complex.h"

namespace affskel::core {

/// A value for each cell at some places, by its own name.  Cells at no lower end of a cube, which are its own, come first;
/// behind them those that few cubes own beside these.
template <class Value>
class CellValues {
 public:
  /// @param places a set, such as those of all cells of a dimension: see DualComplex::places_of_dimension().
  /// @param none every cell's at first.
  CellValues(const DualComplex& complex, std::uint32_t places, Value none)
      : complex_(&complex), others_(places & ~DualComplex::kUpperPlaces) {
    for (std::uint32_t place = 0; place < kPlaces; ++place) {
      if ((places & DualComplex::kUpperPlaces & 1U << place) == 0) continue;
      slot_[place] = static_cast<std::uint8_t>(per_cube_);
      usual_[per_cube_++] = static_cast<std::uint8_t>(place);
    }
    std::size_t end = per_cube_ * std::size_t{complex.cubes()};
    const auto owners = complex.other_owners();
    for (std::size_t owner = 0; owner < owners.size(); ++owner) {
      if (owner % kTogether == 0) first_.push_back(end);
      end += others_of(owners[owner], kPlaces);
    }
    values_.assign(end, none);
  }

  Value& operator[](DualComplex::Cell cell) { return values_[index(cell)]; }
  Value operator[](DualComplex::Cell cell) const { return values_[index(cell)]; }

  /// Calls visit(cell, value) for every one, by cube.
  template <class Visit>
  void for_each(const Visit& visit) {
    std::size_t usual = 0, other = per_cube_ * std::size_t{complex_->cubes()};
    for (std::uint32_t cube = 0; cube < complex_->cubes(); ++cube) {
      for (std::size_t n = 0; n < per_cube_; ++n) visit(DualComplex::name(cube, usual_[n]), values_[usual++]);
      for (std::uint32_t left = complex_->own_places(cube) & others_; left != 0; left &= left - 1)
        visit(DualComplex::name(cube, static_cast<std::uint32_t>(std::countr_zero(left))), values_[other++]);
    }
  }

 private:
  static constexpr std::uint32_t kPlaces = 27;
  static constexpr std::uint32_t kTogether = 4;  // owners of others that one number is kept for

  [[gnu::always_inline]] std::size_t index(DualComplex::Cell cell) const {
    const std::uint32_t cube = DualComplex::cube_of(cell), place = DualComplex::place_of(cell);
    if ((DualComplex::kUpperPlaces >> place & 1U) != 0) return per_cube_ * std::size_t{cube} + slot_[place];
    const auto owners = complex_->other_owners();
    const std::uint32_t owner = complex_->other_owner(cube);
    std::size_t at = first_[owner / kTogether] + others_of(owners[owner], place);
    for (std::uint32_t n = owner - owner % kTogether; n < owner; ++n) at += others_of(owners[n], kPlaces);
    return at;
  }
  // How many there are among what one owns, before a place.
  std::size_t others_of(std::uint32_t own, std::uint32_t place) const {
    return static_cast<std::size_t>(std::popcount(own & others_ & ((1U << place) - 1)));
  }

  const DualComplex* complex_;
  std::uint32_t others_;                      // the places that are at a lower end
  std::size_t per_cube_ = 0;                  // how many are not
  std::array<std::uint8_t, 8> usual_{};       // these
  std::array<std::uint8_t, kPlaces> slot_{};  // where one of them comes
  std::vector<std::size_t> first_;            // where the others of so many that own some begin
  std::vector<Value> values_;
};

/// Cells of a complex.
class CellSet {
 public:
  CellSet() = default;  ///< of no complex
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

/// Of the cells that are looked at the one nearest to the surface, by radius_about(); of equal ones the first by name.
struct WeakestCell {
  std::optional<DualComplex::Cell> cell;
  double radius = 0;

  /// @param of_cubes see radius_about().
  void look_at(const DualComplex& complex, std::span<const float> of_cubes, DualComplex::Cell here) {
    const double about = radius_about(complex, of_cubes, here);
    if (cell && std::pair(about, here) >= std::pair(radius, *cell)) return;
    cell = here;
    radius = about;
  }
};

/// Adds a cell and all cells in its boundary.
void insert_closed(const DualComplex& complex, DualComplex::Cell cell, CellSet& set);

}  // namespace affskel::core
