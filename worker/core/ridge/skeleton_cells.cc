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
  find_rings(complex);
  const std::vector<char> doubled = doubled_edges();
  find_fanned(complex, edges, doubled);
  split(complex, edges, doubled);
}

void SkeletonCells::find_rings(const DualComplex& complex) {
  rings.resize(squares.size());
  for (std::size_t s = 0; s < squares.size(); ++s) {
    const auto around = vertices_round(complex, squares[s]);
    for (std::size_t k = 0; k < 4; ++k) rings[s][k] = number(around[k]);
  }
}

// One without squares rather than one of a surface.
std::vector<char> SkeletonCells::doubled_edges() const {
  std::vector<std::size_t> order(segments.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t e) { return std::tuple(segments[e], squares_at[e] == 0, e); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  std::vector<char> doubled(segments.size(), 0);
  for (std::size_t n = 1; n < order.size(); ++n)
    if (segments[order[n - 1]] == segments[order[n]]) doubled[order[n]] = 1;
  return doubled;
}

void SkeletonCells::find_fanned(const DualComplex& complex, const std::vector<Cell>& edges,
                                const std::vector<char>& split) {
  fanned.assign(squares.size(), 0);
  std::vector<std::pair<std::pair<std::uint32_t, std::uint32_t>, std::size_t>> diagonals;
  diagonals.reserve(2 * squares.size());
  for (std::size_t s = 0; s < squares.size(); ++s) {
    for (std::size_t k = 0; k < 2; ++k) diagonals.emplace_back(std::minmax(rings[s][k], rings[s][k + 2]), s);
    complex.for_each_face(squares[s],
                          [&](Cell edge) { fanned[s] = fanned[s] || split[place_in(edges, edge)]; });
  }
  std::sort(diagonals.begin(), diagonals.end());
  for (std::size_t n = 1; n < diagonals.size(); ++n)
    if (diagonals[n - 1].first == diagonals[n].first) fanned[diagonals[n].second] = 1;
}

void SkeletonCells::split(const DualComplex& complex, const std::vector<Cell>& edges,
                          const std::vector<char>& split) {
  const std::size_t before = vertices.size();
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (split[e]) vertices.push_back(edges[e]);
  for (std::size_t s = 0; s < squares.size(); ++s)
    if (fanned[s]) vertices.push_back(squares[s]);
  if (vertices.size() == before) return;
  std::sort(vertices.begin(), vertices.end());
  find_rings(complex);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    segments[e] = ends(complex, edges[e]);
    if (!split[e]) continue;
    const std::uint32_t middle = number(edges[e]);
    segments.push_back({middle, segments[e][1]});
    squares_at.push_back(squares_at[e]);
    segments[e][1] = middle;
  }
  for (std::size_t s = 0; s < squares.size(); ++s)
    if (fanned[s]) fan_out(complex, squares[s]);
}

// Its spokes are edges with two triangles each.
void SkeletonCells::fan_out(const DualComplex& complex, Cell square) {
  const std::uint32_t centre = number(square);
  const auto spoke = [&](std::uint32_t to) {
    segments.push_back({centre, to});
    squares_at.push_back(2);
  };
  for (const Cell corner : vertices_round(complex, square)) spoke(number(corner));
  complex.for_each_face(square, [&](Cell edge) {
    const auto [a, b] = ends(complex, edge);
    const std::uint32_t middle = number(edge);
    if (middle == vertices.size() || vertices[middle] != edge) {
      fans.push_back({centre, a, b});
      return;
    }
    spoke(middle);
    fans.push_back({centre, a, middle});
    fans.push_back({centre, middle, b});
  });
}

std::uint32_t SkeletonCells::number(Cell vertex) const {
  return static_cast<std::uint32_t>(place_in(vertices, vertex));
}

Segment SkeletonCells::ends(const DualComplex& complex, Cell edge) const {
  const auto [lower, upper] = complex.ends(edge);
  return {number(lower), number(upper)};
}

Adjacency SkeletonCells::rim_neighbours() const {
  std::vector<Segment> rim;
  for (std::size_t s = 0; s < segments.size(); ++s)
    if (squares_at[s] == 1) rim.push_back(segments[s]);
  return neighbours(vertices.size(), rim);
}

}  // namespace affskel::core
