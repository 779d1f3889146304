#include "core/contour/edge_cells.h"

#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "core/lattice/lattice_coordinates.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

struct Entry {
  Cell vertex;
  std::uint32_t edge, corner;  // of the ring
};

std::vector<Entry> entries_of(const DualComplex& complex, std::span<const LatticeEdge> edges) {
  std::vector<Entry> entries;
  entries.reserve(4 * edges.size());
  for (std::uint32_t e = 0; e < edges.size(); ++e) {
    const std::array<Cell, 4> ring = vertices_round(complex, complex.square(edges[e].point, edges[e].axis));
    for (std::uint32_t corner = 0; corner < 4; ++corner) entries.push_back({ring[corner], e, corner});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.vertex != b.vertex ? a.vertex < b.vertex : a.edge < b.edge;
  });
  return entries;
}

}  // namespace

std::array<Cell, 4> vertices_round(const DualComplex& complex, Cell square) {
  const std::uint32_t cube = DualComplex::cube_of(square), place = DualComplex::place_of(square);
  std::size_t axis = 0;
  while (DualComplex::digit(place, axis) == 1) ++axis;
  const std::uint32_t u = DualComplex::kWeight[(axis + 1) % 3], v = DualComplex::kWeight[(axis + 2) % 3];
  return {complex.cell(cube, place - u - v), complex.cell(cube, place + u - v),
          complex.cell(cube, place + u + v), complex.cell(cube, place - u + v)};
}

std::vector<CellPlace> cells_of_vertices(const Lattice& lattice, std::span<const Cell> vertices) {
  std::vector<std::uint32_t> cubes;
  cubes.reserve(vertices.size());
  for (const Cell vertex : vertices) cubes.push_back(DualComplex::cube_of(vertex));
  const std::vector<LatticePlace> places = lattice_places(lattice, cubes);
  std::vector<CellPlace> result(vertices.size());
  for (std::size_t n = 0; n < vertices.size(); ++n)
    for (std::size_t axis = 0; axis < 3; ++axis)
      result[n][axis] = std::int64_t{places[n][axis]} -
                        (DualComplex::digit(DualComplex::place_of(vertices[n]), axis) == 0 ? 1 : 0);
  return result;
}

std::vector<Vec3> places_of_vertices(const Lattice& lattice, std::span<const Cell> vertices) {
  std::vector<Vec3> places;
  for (const CellPlace& cell : cells_of_vertices(lattice, vertices)) places.push_back(middle_of(cell));
  return places;
}

EdgeCells edge_cells(const Lattice& lattice, const DualComplex& complex, const SolidParts& parts,
                     std::span<const LatticeEdge> edges) {
  constexpr std::size_t kMaxEdges = (std::size_t{1} << 30) - 1;  // four entries each, numbered in 32 bits
  if (edges.size() > kMaxEdges) {
    throw CoreError(CoreError::Code::kLimit, "too many crossings to join: " + std::to_string(edges.size()) +
                                                 "; take a larger spacing");
  }
  const std::vector<Entry> entries = entries_of(complex, edges);
  EdgeCells cells;
  cells.ring.resize(edges.size());
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const Entry& entry = entries[e];
    if (e == 0 || entries[e - 1].vertex != entry.vertex) {
      cells.vertex.push_back(entry.vertex);
      cells.whole.push_back(complex.star(entry.vertex).count == 8);
      cells.part.push_back(parts.of_point(DualComplex::cube_of(entry.vertex)));
    }
    cells.ring[entry.edge][entry.corner] = static_cast<std::uint32_t>(cells.vertex.size() - 1);
  }
  cells.edges = holders(cells.vertex.size(), cells.ring);
  cells.place = cells_of_vertices(lattice, cells.vertex);
  return cells;
}

}  // namespace affskel::core
