#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/none.h"
#include "core/lattice/lattice.h"
#include "core/solid/betti_numbers.h"

namespace affskel::core {

/// The cubical complex dual to the sample points of a lattice: a closed cube for every sample point, cubes
/// glued along the square between them where the lattice edge from one to the other lies in the solid (see
/// for_each_edge).  Edges and vertices are glued where the cubes about them hang together through such
/// squares, so that a gap thinner than a spacing parts the complex as it parts the solid.  In its interior
///
///     a cube is dual to a sample point, a square to a lattice edge,
///     an edge to a lattice face, a vertex to a lattice cell.
///
/// A cell is named by a cube that it belongs to and its place there: three digits, one per axis, 0, 1 or 2 as
/// it lies at the cube's lower end, in its middle (where it extends along the axis), or at its upper end.  Of
/// all such names of a cell the one of the lowest cube is its own.  Immutable.
///
/// What a collapse asks ten times for each cell is always compiled in place: left to the compiler, calls took a tenth of it.
class DualComplex {
 public:
  /// 32 * cube + 9 * digit 0 + 3 * digit 1 + digit 2.
  using Cell = std::uint64_t;

  static constexpr std::uint32_t kNone = core::kNone;
  static constexpr std::uint32_t kCube = 13;         ///< the place of the cube itself
  static constexpr std::uint32_t kUpperVertex = 26;  ///< of the vertex at the upper end of all axes
  static constexpr std::array<std::uint32_t, 3> kWeight{9, 3, 1};
  /// The places (a set) that lie at the lower end of no axis.
  static constexpr std::uint32_t kUpperPlaces = [] {
    std::uint32_t places = 0;
    for (std::uint32_t place = kCube; place < 27; ++place)
      if (place / 9 > 0 && place / 3 % 3 > 0 && place % 3 > 0) places |= 1U << place;
    return places;
  }();

  /// O(points + runs); 20 bytes a point.
  explicit DualComplex(const Lattice& lattice);

  std::uint32_t cubes() const { return static_cast<std::uint32_t>(full_.size()); }

  /// The cube glued to one at the lower (0) or upper (2) end of an axis, or kNone.
  [[gnu::always_inline]] std::uint32_t neighbour(std::uint32_t cube, std::size_t axis,
                                                 std::uint32_t digit) const {
    if (axis < 2) return neighbour_[4 * std::size_t{cube} + 2 * axis + (digit >> 1)];
    return (along_[cube] >> digit & 1U) != 0 ? cube + digit - 1 : kNone;
  }

  static std::uint32_t cube_of(Cell cell) { return static_cast<std::uint32_t>(cell >> 5); }
  static std::uint32_t place_of(Cell cell) { return static_cast<std::uint32_t>(cell & 31); }
  static std::uint32_t digit(std::uint32_t place, std::size_t axis) { return kDigits[place][axis]; }
  /// The axes (a set) on which a place lies at an end of its cube.
  static std::uint32_t across(std::uint32_t place) { return kAcross[place]; }
  static int dimension(std::uint32_t place) { return kDimension[place]; }
  static int dimension(Cell cell) { return kDimension[place_of(cell)]; }
  /// All places (a set) of a dimension.
  static constexpr std::uint32_t places_of_dimension(std::uint32_t dimension) {
    std::uint32_t places = 0;
    for (std::uint32_t place = 0; place < 27; ++place)
      if (kDimension[place] == dimension) places |= 1U << place;
    return places;
  }
  static constexpr std::uint32_t kAllPlaces = (1U << 27) - 1;

  /// The own name of the cell at a place of a cube.
  [[gnu::always_inline]] Cell cell(std::uint32_t cube, std::uint32_t place) const {
    if (kLower[place] == 0) return name(cube, place);
    std::uint32_t lowest = cube, raised = place;
    for (std::uint32_t left = kLower[place]; left != 0; left &= left - 1) {
      const auto axis = static_cast<std::size_t>(std::countr_zero(left));
      const std::uint32_t next = neighbour(lowest, axis, 0);
      if (next == kNone) continue;
      lowest = next;
      raised += 2 * kWeight[axis];
    }
    return kLower[raised] == 0 || is_own(lowest, raised) ? name(lowest, raised) : own_name(cube, place);
  }

  /// The places (a set) of a cube that name a cell by its own name.
  [[gnu::always_inline]] std::uint32_t own_places(std::uint32_t cube) const {
    const bool has_others = (groups_[cube / 32].others >> cube % 32 & 1U) != 0;
    return has_others ? own_[other_owner(cube)] : kUpperPlaces;
  }
  /// Of those cubes that own other places than the upper ones, as few do.
  std::span<const std::uint32_t> other_owners() const { return own_; }
  /// Which of them a cube is that does.
  std::uint32_t other_owner(std::uint32_t cube) const {
    const Group& group = groups_[cube / 32];
    const std::uint32_t before = group.others & ((1U << cube % 32) - 1);
    return group.before + static_cast<std::uint32_t>(std::popcount(before));
  }
  bool is_own(std::uint32_t cube, std::uint32_t place) const { return (own_places(cube) >> place & 1U) != 0; }

  /// The cube across a lattice edge from `point` upwards, where one is glued there; else the cell of its end.
  Cell square(std::uint32_t point, std::size_t axis) const { return cell(point, kCube + kWeight[axis]); }

  /// Calls visit(face) for the cells of one dimension less in the boundary of a cell.
  template <class Visit>
  void for_each_face(Cell of, const Visit& visit) const {
    const std::uint32_t cube = cube_of(of), place = place_of(of);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (digit(place, axis) != 1) continue;
      visit(cell(cube, place - kWeight[axis]));
      visit(cell(cube, place + kWeight[axis]));
    }
  }

  /// The lower and the upper vertex of an edge.
  std::array<Cell, 2> ends(Cell edge) const {
    std::array<Cell, 2> found{};
    std::size_t n = 0;
    for_each_face(edge, [&](Cell vertex) { found[n++] = vertex; });
    return found;
  }

  /// The vertex at the other end of an edge from a vertex along an axis, if it has one.
  std::optional<Cell> next_vertex(Cell vertex, std::size_t axis, bool upwards) const;

  /// The square of a cell's distance from the centre of all cubes, spacings; of mirror images to the bit the same.
  double off_centre(Cell of) const;

  /// The cubes about a cell, and its place in each.
  struct Star {
    struct Member {
      std::uint32_t cube = kNone, place = 0;
    };
    std::array<Member, 8> members;
    std::size_t count = 0;

    const Member* begin() const { return members.data(); }
    const Member* end() const { return members.data() + count; }
  };
  Star star(Cell of) const {
    const std::uint32_t cube = cube_of(of), place = place_of(of);
    if (!is_regular(cube, place)) return star(cube, place);
    Star found;
    found.members[found.count++] = {cube, place};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((kAcross[place] >> axis & 1U) == 0) continue;
      const std::uint32_t next = neighbour(cube, axis, 2);
      if (next == kNone) continue;  // a square of the boundary
      for (std::size_t n = 0, known = found.count; n < known; ++n) {
        const Star::Member& member = found.members[n];
        found.members[found.count++] = {neighbour(member.cube, axis, 2), member.place - 2 * kWeight[axis]};
      }
    }
    return found;
  }

  /// As many as cofaces() has.
  std::uint32_t coface_count(Cell of) const {
    const std::uint32_t cube = cube_of(of), place = place_of(of);
    if (!is_regular(cube, place)) return static_cast<std::uint32_t>(cofaces(cube, place).count);
    const std::uint32_t axes = 3U - kDimension[place];
    const bool on_boundary =
        axes == 1 && neighbour(cube, static_cast<std::size_t>(std::countr_zero(across(place))), 2) == kNone;
    return on_boundary ? 1 : 2 * axes;
  }

  /// Which of its coface's faces a cell is: twice the axis along which it lies at an end, and 1 at the upper.
  static std::uint32_t side(std::size_t axis, bool upper) {
    return 2 * static_cast<std::uint32_t>(axis) + (upper ? 1 : 0);
  }
  Cell face(Cell of, std::uint32_t side) const {
    const std::uint32_t place = place_of(of), weight = kWeight[side / 2];
    return cell(cube_of(of), side % 2 != 0 ? place + weight : place - weight);
  }

  /// Calls visit(coface, the cell's side of it) for the cells of one dimension more about a cell, until one returns true:
  /// whether one has.
  template <class Visit>
  bool any_coface(Cell of, const Visit& visit) const {
    const std::uint32_t cube = cube_of(of), place = place_of(of);
    if (!is_regular(cube, place)) {
      const Cofaces about = cofaces(cube, place);
      for (std::size_t n = 0; n < about.count; ++n)
        if (visit(about.cells[n], std::uint32_t{about.sides[n]})) return true;
      return false;
    }
    for (std::uint32_t left = kAcross[place]; left != 0; left &= left - 1) {
      const auto axis = static_cast<std::size_t>(std::countr_zero(left));
      if (visit(name(cube, place - kWeight[axis]), side(axis, true))) return true;
      const std::uint32_t next = neighbour(cube, axis, 2);
      if (next != kNone && visit(name(next, place - kWeight[axis]), side(axis, false))) return true;
    }
    return false;
  }

  /// All of them.
  struct Cofaces {
    std::array<Cell, 24> cells;
    std::array<std::uint8_t, 24> sides;
    std::size_t count = 0;

    const Cell* begin() const { return cells.data(); }
    const Cell* end() const { return cells.data() + count; }
    void add(Cell coface, std::uint32_t side) {
      cells[count] = coface;
      sides[count++] = static_cast<std::uint8_t>(side);
    }
  };
  Cofaces cofaces(Cell of) const {
    Cofaces found;
    any_coface(of, [&](Cell coface, std::uint32_t side) {
      found.add(coface, side);
      return false;
    });
    return found;
  }

  /// Calls visit(cell) for every cell once, by its own name.
  template <class Visit>
  void for_each_cell(const Visit& visit) const {
    for (std::uint32_t cube = 0; cube < cubes(); ++cube)
      for (std::uint32_t left = own_places(cube); left != 0; left &= left - 1)
        visit(name(cube, static_cast<std::uint32_t>(std::countr_zero(left))));
  }

  /// Calls visit(neighbour, steps) for the cubes that share a cell with one all of whose cubes are there:
  /// 1, 2 or 3 steps along different axes.
  template <class Visit>
  void for_each_step(std::uint32_t cube, const Visit& visit) const {
    std::array<std::uint32_t, 27> at;  // the cube at the other side of each place
    at.fill(kNone);
    at[kCube] = cube;
    const auto extend = [&](std::uint32_t from, std::size_t axis) {
      if (at[from] == kNone) return;
      at[from - kWeight[axis]] = neighbour(at[from], axis, 0);
      at[from + kWeight[axis]] = neighbour(at[from], axis, 2);
    };
    extend(kCube, 0);
    for (std::uint32_t a = 0; a < 3; ++a) extend(9 * a + 4, 1);
    for (std::uint32_t n = 0; n < 9; ++n) extend(3 * n + 1, 2);
    for (std::uint32_t place = 0; place < 27; ++place) {
      const std::uint32_t lowest = at[kLowest[place]];
      if (place == kCube || at[place] == kNone || lowest == kNone) continue;
      if (is_full(lowest, kAcross[place])) visit(at[place], static_cast<std::uint32_t>(3 - dimension(place)));
    }
  }

  static Cell name(std::uint32_t cube, std::uint32_t place) { return Cell{cube} << 5 | place; }

 private:
  static constexpr std::array<std::array<std::uint8_t, 3>, 27> kDigits = [] {
    std::array<std::array<std::uint8_t, 3>, 27> digits{};
    for (std::uint8_t place = 0; place < 27; ++place)
      digits[place] = {static_cast<std::uint8_t>(place / 9), static_cast<std::uint8_t>(place / 3 % 3),
                       static_cast<std::uint8_t>(place % 3)};
    return digits;
  }();

  // Per place the sum of term(axis, digit) over the axes.
  static constexpr auto per_place = [](const auto& term) {
    std::array<std::uint8_t, 27> sums{};
    for (std::size_t place = 0; place < 27; ++place)
      for (std::size_t axis = 0; axis < 3; ++axis)
        sums[place] = static_cast<std::uint8_t>(sums[place] + term(axis, kDigits[place][axis]));
    return sums;
  };
  static constexpr auto kDimension = per_place([](std::size_t, auto digit) { return digit == 1 ? 1U : 0U; });
  // The axes (a set) on which a place lies at an end of the cube, and those of the lower end.
  static constexpr auto kAcross =
      per_place([](std::size_t axis, auto digit) { return digit != 1 ? 1U << axis : 0U; });
  static constexpr auto kLower =
      per_place([](std::size_t axis, auto digit) { return digit == 0 ? 1U << axis : 0U; });
  // Where, beyond the lower ends alone, the lowest cube about a place lies.
  static constexpr auto kLowest =
      per_place([](std::size_t axis, auto digit) { return kWeight[axis] * (digit == 0 ? 0U : 1U); });

  std::uint32_t find_own_places(std::uint32_t cube) const;
  Cell own_name(std::uint32_t cube, std::uint32_t place) const;
  [[gnu::always_inline]] bool is_full(std::uint32_t lowest, std::uint32_t axes) const {
    return (full_[lowest] >> axes & 1U) != 0;
  }
  // Named from the lowest of the cubes about it, all of which are there and glued to each other.
  [[gnu::always_inline]] bool is_regular(std::uint32_t cube, std::uint32_t place) const {
    return kLower[place] == 0 && is_full(cube, kAcross[place]);
  }
  struct Around;
  Around around(std::uint32_t cube, std::uint32_t place) const;
  Star star(std::uint32_t cube, std::uint32_t place) const;
  Cofaces cofaces(std::uint32_t cube, std::uint32_t place) const;

  // Cubes one after another along axis 2.
  struct Run {
    std::uint32_t first = 0;
    std::array<std::uint32_t, 3> start{};
  };

  std::vector<Run> runs_;
  std::array<std::uint64_t, 3> sum_{};    // of all cubes' places
  std::vector<std::uint32_t> neighbour_;  // four per cube: axis 0 lower, upper, axis 1 lower, upper
  std::vector<std::uint8_t>
      along_;  // per cube: whether the one before (bit 0) and after (2) are glued, along axis 2
  // Per cube, bit `axes` (a set of them): the cubes up to one step up along these axes are all there and glued
  // to each other; set for one axis and none.
  std::vector<std::uint8_t> full_;
  // Of 32 cubes: those that own other places than the upper ones, as few do, and how many do before them.
  struct Group {
    std::uint32_t others = 0, before = 0;
  };
  std::vector<Group> groups_;
  std::vector<std::uint32_t> own_;  // of those: see own_places()
};

/// The greatest distance to the surface among the cubes about a cell.
/// @param radius per cube.
inline double radius_about(const DualComplex& complex, std::span<const float> radius,
                           DualComplex::Cell cell) {
  float most = 0;
  for (const auto& member : complex.star(cell)) most = std::max(most, radius[member.cube]);
  return static_cast<double>(most);
}

/// Where a value of cubes is continued to a cell: from all cubes about it, or only across what bounds the complex.
enum class Continued { kFromAllCubes, kAcrossBoundary };

/// A value of cubes at the middle of a cell, continued to there from cubes about it, as it changes towards such a
/// cube's far side, and averaged: cells of one cube have different ones, and mirror images the same.  Continued from all,
/// it is too small where the value grows faster and faster, and may fall where that rises.
/// @param value value(cube).
template <Continued kContinued, class Value>
double value_at(const DualComplex& complex, DualComplex::Cell cell, const Value& value) {
  const DualComplex::Star star = complex.star(cell);
  const std::uint32_t across = DualComplex::across(DualComplex::place_of(cell));
  double sum = 0;
  for (const auto& [cube, place] : star) {
    const double here = value(cube);
    sum += here;
    for (std::uint32_t left = across; left != 0; left &= left - 1) {
      const auto axis = static_cast<std::size_t>(std::countr_zero(left));
      const std::uint32_t digit = DualComplex::digit(place, axis);
      if (kContinued == Continued::kAcrossBoundary && complex.neighbour(cube, axis, digit) != kNone) continue;
      const std::uint32_t behind = complex.neighbour(cube, axis, 2 - digit);
      if (behind != kNone) sum += 0.5 * (here - value(behind));
    }
  }
  return sum / static_cast<double>(star.count);
}

/// A cell in an order that mirror images share: by a level, and of those that have one up to rounding, as the two faces
/// of what is one cube thick, the farthest from the middle of the complex first.
class CellRank {
 public:
  /// @param level below 2^14.
  CellRank(const DualComplex& complex, double level, DualComplex::Cell cell)
      : complex_(&complex), level_(std::nearbyint(level * 0x1p38)), cell_(cell) {}

  bool operator<(const CellRank& other) const {
    if (level_ != other.level_) return level_ < other.level_;
    const double off = complex_->off_centre(cell_), other_off = complex_->off_centre(other.cell_);
    return off != other_off ? off > other_off : cell_ < other.cell_;
  }

 private:
  const DualComplex* complex_;
  double level_;
  DualComplex::Cell cell_;
};

/// The Betti numbers of the whole complex: cavities are the closed pieces of its boundary beyond one for each
/// component (Alexander duality), holes follow from the Euler characteristic.
/// @throws CoreError kCancelled when the context asks to stop.
BettiNumbers betti_numbers(const DualComplex& complex, ExecutionContext* context = nullptr);

}  // namespace affskel::core
