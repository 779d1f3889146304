#include "core/ridge/skeleton_cells.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>

#include "core/contour/edge_cells.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

std::size_t place_in(const std::vector<Cell>& cells, Cell cell) {
  return static_cast<std::size_t>(std::lower_bound(cells.begin(), cells.end(), cell) - cells.begin());
}

template <class Wanted>
Groups<std::uint32_t> neighbours_along(const SkeletonCells& cells, const Wanted& wanted) {
  return {cells.vertices.size(), [&](const auto& put) {
            for (std::size_t s = 0; s < cells.segments.size(); ++s) {
              if (!wanted(cells.squares_at[s])) continue;
              put(cells.segments[s][0], cells.segments[s][1]);
              put(cells.segments[s][1], cells.segments[s][0]);
            }
          }};
}

}  // namespace

SkeletonCells::SkeletonCells(const DualComplex& complex, const CellSet& left) {
  std::vector<Cell> edges;
  left.for_each([&](Cell cell) {
    const int dimension = DualComplex::dimension(cell);
    (dimension == 0 ? vertices : dimension == 1 ? edges : squares).push_back(cell);
  });
  squares_at.assign(edges.size(), 0);
  for (const Cell square : squares)
    complex.for_each_face(square, [&](Cell edge) { ++squares_at[place_in(edges, edge)]; });
  for (const Cell edge : edges) segments.push_back(ends(complex, edge));
  split_doubled(complex, edges);
  rings.reserve(squares.size());
  for (const Cell square : squares) {
    auto& ring = rings.emplace_back();
    const auto around = vertices_round(complex, square);
    for (std::size_t k = 0; k < 4; ++k) ring[k] = number(around[k]);
  }
}

void SkeletonCells::split_doubled(const DualComplex& complex, const std::vector<Cell>& edges) {
  std::vector<std::size_t> order(edges.size()), doubled;
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t e) { return std::tuple(segments[e], squares_at[e] == 0, e); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  for (std::size_t n = 1; n < order.size(); ++n)
    if (segments[order[n - 1]] == segments[order[n]] && squares_at[order[n]] == 0)
      doubled.push_back(order[n]);
  if (doubled.empty()) return;
  for (const std::size_t e : doubled) vertices.push_back(edges[e]);
  std::sort(vertices.begin(), vertices.end());
  for (std::size_t e = 0; e < edges.size(); ++e) segments[e] = ends(complex, edges[e]);
  for (const std::size_t e : doubled) {
    const std::uint32_t middle = number(edges[e]);
    segments.push_back({middle, segments[e][1]});
    squares_at.push_back(0);
    segments[e][1] = middle;
  }
}

std::uint32_t SkeletonCells::number(Cell vertex) const {
  return static_cast<std::uint32_t>(place_in(vertices, vertex));
}

std::array<std::uint32_t, 2> SkeletonCells::ends(const DualComplex& complex, Cell edge) const {
  std::array<std::uint32_t, 2> result{};
  std::size_t n = 0;
  complex.for_each_face(edge, [&](Cell vertex) { result[n++] = number(vertex); });
  return result;
}

Groups<std::uint32_t> SkeletonCells::neighbours() const {
  return neighbours_along(*this, [](std::uint8_t) { return true; });
}

Groups<std::uint32_t> SkeletonCells::rim_neighbours() const {
  return neighbours_along(*this, [](std::uint8_t count) { return count == 1; });
}

}  // namespace affskel::core
