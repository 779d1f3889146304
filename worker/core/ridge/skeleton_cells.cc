#include "core/ridge/skeleton_cells.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/contour/edge_cells.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

std::size_t place_in(const std::vector<Cell>& cells, Cell cell) {
  return static_cast<std::size_t>(std::lower_bound(cells.begin(), cells.end(), cell) - cells.begin());
}

Segment ends_of(const DualComplex& complex, const SkeletonCells& cells, Cell edge) {
  const auto [lower, upper] = complex.ends(edge);
  return {cells.number(lower), cells.number(upper)};
}

void find_rings(const DualComplex& complex, SkeletonCells& cells) {
  cells.rings.resize(cells.squares.size());
  for (std::size_t s = 0; s < cells.squares.size(); ++s) {
    const auto around = vertices_round(complex, cells.squares[s]);
    for (std::size_t k = 0; k < 4; ++k) cells.rings[s][k] = cells.number(around[k]);
  }
}

// One without squares rather than one of a surface.
std::vector<char> doubled_edges(const SkeletonCells& cells) {
  const std::vector<Segment>& segments = cells.segments;
  std::vector<std::size_t> order(segments.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t e) { return std::tuple(segments[e], cells.squares_at[e] == 0, e); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  std::vector<char> doubled(segments.size(), 0);
  for (std::size_t n = 1; n < order.size(); ++n)
    if (segments[order[n - 1]] == segments[order[n]]) doubled[order[n]] = 1;
  return doubled;
}

// @param split per edge.
void find_fanned(const DualComplex& complex, const std::vector<Cell>& edges, const std::vector<char>& split,
                 SkeletonCells& cells) {
  const std::vector<Cell>& squares = cells.squares;
  cells.fanned.assign(squares.size(), 0);
  std::vector<std::pair<std::pair<std::uint32_t, std::uint32_t>, std::size_t>> diagonals;
  diagonals.reserve(2 * squares.size());
  for (std::size_t s = 0; s < squares.size(); ++s) {
    const auto& ring = cells.rings[s];
    for (std::size_t k = 0; k < 2; ++k) diagonals.emplace_back(std::minmax(ring[k], ring[k + 2]), s);
    complex.for_each_face(
        squares[s], [&](Cell edge) { cells.fanned[s] = cells.fanned[s] || split[place_in(edges, edge)]; });
  }
  std::sort(diagonals.begin(), diagonals.end());
  for (std::size_t n = 1; n < diagonals.size(); ++n)
    if (diagonals[n - 1].first == diagonals[n].first) cells.fanned[diagonals[n].second] = 1;
}

// Its spokes are edges with two triangles each.
void fan_out(const DualComplex& complex, Cell square, SkeletonCells& cells) {
  const std::uint32_t centre = cells.number(square);
  const auto spoke = [&](std::uint32_t to) {
    cells.segments.push_back({centre, to});
    cells.squares_at.push_back(2);
  };
  for (const Cell corner : vertices_round(complex, square)) spoke(cells.number(corner));
  complex.for_each_face(square, [&](Cell edge) {
    const auto [a, b] = ends_of(complex, cells, edge);
    const std::uint32_t middle = cells.number(edge);
    if (middle == cells.vertices.size() || cells.vertices[middle] != edge) {
      cells.fans.push_back({centre, a, b});
      return;
    }
    spoke(middle);
    cells.fans.push_back({centre, a, middle});
    cells.fans.push_back({centre, middle, b});
  });
}

void split_doubled(const DualComplex& complex, const std::vector<Cell>& edges, const std::vector<char>& split,
                   SkeletonCells& cells) {
  const std::size_t before = cells.vertices.size();
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (split[e]) cells.vertices.push_back(edges[e]);
  for (std::size_t s = 0; s < cells.squares.size(); ++s)
    if (cells.fanned[s]) cells.vertices.push_back(cells.squares[s]);
  if (cells.vertices.size() == before) return;
  std::sort(cells.vertices.begin(), cells.vertices.end());
  find_rings(complex, cells);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    cells.segments[e] = ends_of(complex, cells, edges[e]);
    if (!split[e]) continue;
    const std::uint32_t middle = cells.number(edges[e]);
    cells.segments.push_back({middle, cells.segments[e][1]});
    cells.squares_at.push_back(cells.squares_at[e]);
    cells.segments[e][1] = middle;
  }
  for (std::size_t s = 0; s < cells.squares.size(); ++s)
    if (cells.fanned[s]) fan_out(complex, cells.squares[s], cells);
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
  for (const Cell edge : edges) segments.push_back(ends_of(complex, *this, edge));
  find_rings(complex, *this);
  const std::vector<char> doubled = doubled_edges(*this);
  find_fanned(complex, edges, doubled, *this);
  split_doubled(complex, edges, doubled, *this);
}

std::uint32_t SkeletonCells::number(Cell vertex) const {
  return static_cast<std::uint32_t>(place_in(vertices, vertex));
}

Adjacency SkeletonCells::rim_neighbours() const {
  std::vector<Segment> rim;
  for (std::size_t s = 0; s < segments.size(); ++s)
    if (squares_at[s] == 1) rim.push_back(segments[s]);
  return neighbours(vertices.size(), rim);
}

}  // namespace affskel::core
