#include "core/collapse/dual_complex.h"

#include <array>
#include <bit>
#include <iterator>
#include <unordered_map>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/lattice/lattice_edges.h"

namespace affskel::core {
namespace {

// Calls visit(bit) for those of a set.
template <class Visit>
void for_each_bit(std::uint32_t set, const Visit& visit) {
  for (; set != 0; set &= set - 1) visit(static_cast<std::uint32_t>(std::countr_zero(set)));
}

// Sides (a set) on the other side of a cell along an axis.
std::uint32_t across_axis(std::uint32_t sides, std::uint32_t axis) {
  constexpr std::array<std::uint32_t, 3> kLow{0x55, 0x33, 0x0F};
  return (sides & kLow[axis]) << (1U << axis) | (sides >> (1U << axis) & kLow[axis]);
}

}  // namespace

DualComplex::DualComplex(const Lattice& lattice)
    : neighbour_(4 * std::size_t{lattice.points}, kNone),
      along_(lattice.points, 0),
      full_(lattice.points, 0b00010111) {
  for_each_edge(lattice, [&](std::uint32_t low, std::uint32_t high, std::uint8_t axis, const auto&) {
    if (axis == 2) {
      along_[low] = static_cast<std::uint8_t>(along_[low] | 4U);
      along_[high] = static_cast<std::uint8_t>(along_[high] | 1U);
      return;
    }
    neighbour_[4 * std::size_t{low} + 2 * axis + 1] = high;
    neighbour_[4 * std::size_t{high} + 2 * axis] = low;
  });
  for (const LatticeRun& run : lattice.axis[2].runs) {
    runs_.push_back({run.first, run.start});
    const std::uint64_t length = run.length;
    for (std::size_t axis = 0; axis < 3; ++axis) sum_[axis] += length * run.start[axis];
    sum_[2] += length * (length - 1) / 2;
  }
  const auto up = [&](std::uint32_t cube, std::size_t axis) {
    return cube == kNone ? kNone : neighbour(cube, axis, 2);
  };
  const auto is_square = [&](std::uint32_t cube, std::size_t a, std::size_t b) {
    const std::uint32_t end = up(up(cube, a), b);
    return end != kNone && end == up(up(cube, b), a);
  };
  for (std::uint32_t cube = 0; cube < lattice.points; ++cube) {
    bool all = true;
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = a + 1; b < 3; ++b) {
        const bool square = is_square(cube, a, b);
        if (square) full_[cube] = static_cast<std::uint8_t>(full_[cube] | 1U << (1U << a | 1U << b));
        all = all && square && is_square(up(cube, 3 - a - b), a, b);
      }
    }
    if (all) full_[cube] = static_cast<std::uint8_t>(full_[cube] | 1U << 7);
  }
  for (std::uint32_t cube = 0; cube < lattice.points; ++cube) {
    if (cube % 32 == 0) groups_.push_back({0, static_cast<std::uint32_t>(own_.size())});
    const std::uint32_t own = find_own_places(cube);
    if (own == kUpperPlaces) continue;
    groups_.back().others |= 1U << cube % 32;
    own_.push_back(own);
  }
}

std::uint32_t DualComplex::find_own_places(std::uint32_t cube) const {
  std::uint32_t glued = 0;  // axes along which a cube before it shares what lies there
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (neighbour(cube, axis, 0) != kNone) glued |= 1U << axis;
  std::uint32_t own = 0;
  for (std::uint32_t place = 0; place < 27; ++place) {
    if ((kLower[place] & glued) != 0) continue;
    if (is_regular(cube, place) || own_name(cube, place) == name(cube, place)) own |= 1U << place;
  }
  return own;
}

// The cubes about a cell, by side: the axes (a set) along which one lies on the other side of the cell than the first.
struct DualComplex::Around {
  std::uint32_t place = 0;
  std::array<std::uint32_t, 8> cube;
  std::array<std::uint8_t, 8> sides;  // of those that are there, in the order in which they were found
  std::uint32_t count = 0, there = 0;
  std::array<std::uint32_t, 3> glued{};  // per axis: the sides (a set) of cubes that are, to the one across

  std::uint32_t digit_at(std::uint32_t side, std::uint32_t axis) const {
    const std::uint32_t here = digit(place, axis);
    return (side >> axis & 1U) != 0 ? 2 - here : here;
  }
  std::uint32_t place_at(std::uint32_t side) const {
    std::uint32_t result = place;
    for_each_bit(side, [&](std::uint32_t axis) { result += (2 - 2 * digit(place, axis)) * kWeight[axis]; });
    return result;
  }
  void add(std::uint32_t side, std::uint32_t at) {
    cube[side] = at;
    sides[count++] = static_cast<std::uint8_t>(side);
    there |= 1U << side;
  }
};

DualComplex::Around DualComplex::around(std::uint32_t cube, std::uint32_t place) const {
  Around found;
  found.place = place;
  found.add(0, cube);
  for (std::uint32_t n = 0; n < found.count; ++n) {
    const std::uint32_t side = found.sides[n];
    for_each_bit(kAcross[place], [&](std::uint32_t axis) {
      const std::uint32_t next = neighbour(found.cube[side], axis, found.digit_at(side, axis));
      if (next == kNone) return;
      const std::uint32_t other = side ^ 1U << axis;
      found.glued[axis] |= 1U << side;
      if ((found.there >> other & 1U) == 0) found.add(other, next);
    });
  }
  return found;
}

DualComplex::Cell DualComplex::own_name(std::uint32_t cube, std::uint32_t place) const {
  if (dimension(place) == 2) return name(cube, place);  // of the complex's boundary
  const Around found = around(cube, place);
  std::uint32_t lowest = 0;
  for_each_bit(found.there, [&](std::uint32_t side) {
    if (found.cube[side] < found.cube[lowest]) lowest = side;
  });
  return name(found.cube[lowest], found.place_at(lowest));
}

std::optional<DualComplex::Cell> DualComplex::next_vertex(Cell vertex, std::size_t axis, bool upwards) const {
  for (const auto& [cube, place] : star(vertex)) {
    if (digit(place, axis) != (upwards ? 0U : 2U)) continue;
    return cell(cube, upwards ? place + 2 * kWeight[axis] : place - 2 * kWeight[axis]);
  }
  return std::nullopt;
}

double DualComplex::off_centre(Cell of) const {
  const std::uint32_t cube = cube_of(of), place = place_of(of);
  const Run& run = *std::prev(std::ranges::upper_bound(runs_, cube, {}, &Run::first));
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Twice the way times the number of cubes is a whole number.
    const std::int64_t at =
        2 * (std::int64_t{run.start[axis]} + (axis == 2 ? cube - run.first : 0)) + digit(place, axis) - 1;
    const auto way =
        static_cast<double>(at * cubes() - 2 * static_cast<std::int64_t>(sum_[axis])) / (2.0 * cubes());
    sum += way * way;
  }
  return sum;
}

DualComplex::Star DualComplex::star(std::uint32_t cube, std::uint32_t place) const {
  const Around found = around(cube, place);
  Star result;
  for (; result.count < found.count; ++result.count) {
    const std::uint32_t side = found.sides[result.count];
    result.members[result.count] = {found.cube[side], found.place_at(side)};
  }
  return result;
}

// Along an axis there is one for all cubes on a side that hang together about it.
DualComplex::Cofaces DualComplex::cofaces(std::uint32_t cube, std::uint32_t place) const {
  const Around about = around(cube, place);
  Cofaces found;
  for_each_bit(kAcross[place], [&](std::uint32_t axis) {
    for (std::uint32_t left = about.there; left != 0;) {
      const auto first = static_cast<std::uint32_t>(std::countr_zero(left));
      std::uint32_t together = 1U << first, before = 0, lowest = first;
      while (together != std::exchange(before, together))
        for_each_bit(kAcross[place] & ~(1U << axis), [&](std::uint32_t other) {
          together |= across_axis(before & about.glued[other], other);
        });
      for_each_bit(together, [&](std::uint32_t side) {
        if (about.cube[side] < about.cube[lowest]) lowest = side;
      });
      const std::uint32_t there = about.place_at(lowest);
      const bool upper = about.digit_at(lowest, axis) != 0;
      found.add(name(about.cube[lowest], upper ? there - kWeight[axis] : there + kWeight[axis]),
                side(axis, upper));
      left &= ~together;
    }
  });
  return found;
}

BettiNumbers betti_numbers(const DualComplex& complex, ExecutionContext* context) {
  using Cell = DualComplex::Cell;
  DisjointSets cubes(complex.cubes());
  std::uint64_t components = complex.cubes();
  std::int64_t euler = 0;
  // Squares of the boundary, joined over its edges: each lies between two of them.
  std::vector<Cell> boundary;
  StopCheck stop(context);
  complex.for_each_cell([&](Cell cell) {
    stop.did(10);
    const int dimension = DualComplex::dimension(cell);
    euler += dimension % 2 == 0 ? 1 : -1;
    if (dimension != 2) return;
    const auto star = complex.star(cell);
    if (star.count == 1)
      boundary.push_back(cell);
    else if (cubes.unite(star.members[0].cube, star.members[1].cube))
      --components;
  });
  DisjointSets surfaces(boundary.size());
  std::uint64_t pieces = boundary.size();
  std::unordered_map<Cell, std::uint32_t> at_edge;
  for (std::uint32_t s = 0; s < boundary.size(); ++s) {
    complex.for_each_face(boundary[s], [&](Cell edge) {
      const auto [known, fresh] = at_edge.try_emplace(edge, s);
      if (!fresh && surfaces.unite(known->second, s)) --pieces;
    });
  }
  BettiNumbers result;
  result.components = components;
  result.cavities = pieces - components;
  result.holes = static_cast<std::uint64_t>(static_cast<std::int64_t>(components + result.cavities) - euler);
  return result;
}

}  // namespace affskel::core
