#include "block_solid.h"

#include <algorithm>
#include <map>
#include <optional>

namespace affskel::fuzz {

using core::Vec3;

std::array<std::size_t, 3> BlockSolid::at(std::size_t cell) const {
  return {cell / cells(2) / cells(1), cell / cells(2) % cells(1), cell % cells(2)};
}

// visit(neighbour, axis, ahead): of the cells that share a face.
template <typename Visit>
void BlockSolid::for_each_neighbour(std::size_t cell, Visit visit) const {
  const std::array<std::size_t, 3> place = at(cell), step = {cells(1) * cells(2), cells(2), 1};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    visit(place[axis] > 0 ? std::optional(cell - step[axis]) : std::nullopt, axis, false);
    visit(place[axis] + 1 < cells(axis) ? std::optional(cell + step[axis]) : std::nullopt, axis, true);
  }
}

core::Mesh BlockSolid::mesh() const {
  core::Mesh mesh;
  std::map<std::array<std::size_t, 3>, std::uint32_t> known;
  const auto vertex = [&](const std::array<std::size_t, 3>& corner) {
    const auto [entry, fresh] = known.try_emplace(corner, static_cast<std::uint32_t>(mesh.points.size()));
    if (fresh) mesh.points.push_back({planes[0][corner[0]], planes[1][corner[1]], planes[2][corner[2]]});
    return entry->second;
  };
  for (std::size_t cell = 0; cell < full.size(); ++cell) {
    if (!full[cell]) continue;
    for_each_neighbour(cell, [&](std::optional<std::size_t> beside, std::size_t axis, bool ahead) {
      if (beside && full[*beside]) return;
      std::array<std::uint32_t, 4> around{};
      for (std::size_t n = 0; n < 4; ++n) {
        std::array<std::size_t, 3> corner = at(cell);
        corner[axis] += ahead;
        corner[(axis + 1) % 3] += n == 1 || n == 2;
        corner[(axis + 2) % 3] += n >= 2;
        around[n] = vertex(corner);
      }
      if (!ahead) std::swap(around[1], around[3]);
      mesh.triangles.push_back({around[0], around[1], around[2]});
      mesh.triangles.push_back({around[0], around[2], around[3]});
    });
  }
  return mesh;
}

double BlockSolid::volume() const {
  double volume = 0;
  for (std::size_t cell = 0; cell < full.size(); ++cell) {
    const auto [i, j, k] = at(cell);
    if (full[cell]) volume += side(0, i) * side(1, j) * side(2, k);
  }
  return volume;
}

std::size_t BlockSolid::solids() const {
  std::vector<bool> seen(full.size(), false);
  std::size_t count = 0;
  for (std::size_t first = 0; first < full.size(); ++first) {
    if (!full[first] || seen[first]) continue;
    ++count;
    std::vector<std::size_t> open{first};
    seen[first] = true;
    while (!open.empty()) {
      const std::size_t cell = open.back();
      open.pop_back();
      for_each_neighbour(cell, [&](std::optional<std::size_t> next, std::size_t, bool) {
        if (!next || !full[*next] || seen[*next]) return;
        seen[*next] = true;
        open.push_back(*next);
      });
    }
  }
  return count;
}

// Of the cells on one side of a plane, what hangs together with one of them.
double BlockSolid::piece(std::size_t from, std::size_t axis, double height, bool below) const {
  const auto left = [&](std::size_t c) {  // of the side of a cell along the axis
    const double low = planes[axis][c], high = planes[axis][c + 1];
    return below ? std::min(high, height) - low : high - std::max(low, height);
  };
  std::vector<bool> seen(full.size(), false);
  std::vector<std::size_t> open{from};
  seen[from] = true;
  double volume = 0;
  while (!open.empty()) {
    const std::size_t cell = open.back();
    open.pop_back();
    const std::array<std::size_t, 3> place = at(cell);
    volume += left(place[axis]) * side((axis + 1) % 3, place[(axis + 1) % 3]) *
              side((axis + 2) % 3, place[(axis + 2) % 3]);
    for_each_neighbour(cell, [&](std::optional<std::size_t> next, std::size_t, bool) {
      if (!next || !full[*next] || seen[*next] || !(left(at(*next)[axis]) > 0)) return;
      seen[*next] = true;
      open.push_back(*next);
    });
  }
  return volume;
}

double BlockSolid::axis_erosion(const Vec3& x) const {
  std::array<std::size_t, 3> place{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<double>& cuts = planes[axis];
    const double c = x[static_cast<int>(axis)];
    if (c <= cuts.front() || c >= cuts.back()) return 0;
    place[axis] = static_cast<std::size_t>(std::ranges::upper_bound(cuts, c) - cuts.begin()) - 1;
  }
  const std::size_t from = cell(place[0], place[1], place[2]);
  if (!full[from]) return 0;
  double least = volume();
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const bool below : {true, false})
      least = std::min(least, piece(from, axis, x[static_cast<int>(axis)], below));
  return least;
}

}  // namespace affskel::fuzz
