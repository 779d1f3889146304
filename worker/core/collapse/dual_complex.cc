#include "core/collapse/dual_complex.h"

#include <iterator>
#include <unordered_map>

#include "core/base/disjoint_sets.h"
#include "core/lattice/lattice_edges.h"

namespace affskel::core {

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
}

DualComplex::Cell DualComplex::own_name(std::uint32_t cube, std::uint32_t place) const {
  if (dimension(place) == 2) return name(cube, place);  // of the complex's boundary
  Cell own = name(cube, place);
  for (const Star::Member& member : star(cube, place)) own = std::min(own, name(member.cube, member.place));
  return own;
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
  // The cubes about the cell, by the axes (a set) along which they lie on the other side of it than `cube`.
  Star found;
  std::array<bool, 8> known{};
  std::array<std::uint32_t, 8> sides{};
  known[0] = true;
  found.members[found.count++] = {cube, place};
  for (std::size_t n = 0; n < found.count; ++n) {
    const auto [at, there] = found.members[n];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t d = digit(there, axis);
      const std::uint32_t side = sides[n] ^ 1U << axis;
      if (d == 1 || known[side]) continue;
      const std::uint32_t next = neighbour(at, axis, d);
      if (next == kNone) continue;
      known[side] = true;
      sides[found.count] = side;
      found.members[found.count++] = {next, d == 0 ? there + 2 * kWeight[axis] : there - 2 * kWeight[axis]};
    }
  }
  return found;
}

DualComplex::Cofaces DualComplex::cofaces(const Star& star) const {
  Cofaces found;
  for (const auto& [cube, place] : star) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t d = digit(place, axis);
      if (d == 1) continue;
      const Cell coface = cell(cube, d == 0 ? place + kWeight[axis] : place - kWeight[axis]);
      if (std::find(found.begin(), found.end(), coface) == found.end()) found.cells[found.count++] = coface;
    }
  }
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
