#include "core/ridge/filled_tunnels.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <unordered_map>
#include <utility>

#include "core/base/parity_rows.h"
#include "core/collapse/collapse.h"
#include "core/collapse/shortest_loops.h"
#include "core/contour/edge_cells.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/ridge/ridge_constants.h"
#include "core/solid/betti_numbers.h"
#include "core/solid/surface_loops.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

// Of a limb, spacings: shorter lines than that are steps of the lattice.
constexpr double kLeastWidth = 2;

// A closed way along edges of the complex, or a sum of such ways modulo 2.
struct Cycle {
  std::vector<Cell> edges;   // ascending
  std::vector<char> linked;  // per loop of the solid's surface

  void add(const Cycle& other) {
    edges = parity_sum(edges, other.edges);
    for (std::size_t n = 0; n < linked.size(); ++n) linked[n] ^= other.linked[n];
  }
  bool has(Cell edge) const { return std::binary_search(edges.begin(), edges.end(), edge); }
};

class Tunnels {
 public:
  Tunnels(const Solid& solid, const Lattice& lattice, const DualComplex& complex,
          std::span<const float> radius)
      : lattice_(lattice), complex_(complex), radius_(radius) {
    for (const auto& loop : surface_loops(solid.mesh)) {
      auto& places = of_surface_.emplace_back();
      for (const std::uint32_t v : loop) places.push_back(solid.mesh.points[v]);
    }
  }

  Cycle cycle_of(const CellLoop& loop_in_graph) const {
    Cycle cycle{loop_in_graph.edges, {}};
    const std::vector<Vec3> places = places_along(loop_in_graph);
    for (const std::vector<Vec3>& loop : of_surface_) cycle.linked.push_back(is_linked(places, loop));
    std::sort(cycle.edges.begin(), cycle.edges.end());
    return cycle;
  }

  // Of cycles those, and their sums, that bound a surface in the solid: by elimination, each once.
  static std::vector<Cycle> bounding(std::vector<Cycle> cycles) {
    std::vector<Cycle> kept, result;
    for (Cycle& cycle : cycles) {
      for (const Cycle& other : kept)
        if (cycle.linked[first_of(other)]) cycle.add(other);
      (first_of(cycle) < cycle.linked.size() ? kept : result).push_back(std::move(cycle));
    }
    return result;
  }

  // The edge of a cycle nearest to the surface among those of no square that may go.
  std::optional<Cell> weakest_edge(const Cycle& cycle, const CellSet& left, const CellSet& anchored) const {
    WeakestCell weakest;
    for (const Cell edge : cycle.edges)
      if (!anchored.has(edge) && is_bare(complex_, edge, left)) weakest.look_at(complex_, radius_, edge);
    return weakest.cell;
  }

 private:
  static std::size_t first_of(const Cycle& cycle) {
    return static_cast<std::size_t>(std::find(cycle.linked.begin(), cycle.linked.end(), 1) -
                                    cycle.linked.begin());
  }

  // The same loop along sample points and lattice edges, which lie in the solid.  Scaled coordinates.
  std::vector<Vec3> places_along(const CellLoop& loop) const {
    const auto& [vertices, edges] = loop;
    std::vector<std::uint32_t> points;
    for (std::size_t n = 0; n < edges.size(); ++n) {
      const std::size_t next = (n + 1) % edges.size();
      append_way(vertices[next], complex_.star(edges[n]).members[0].cube,
                 complex_.star(edges[next]).members[0].cube, points);
    }
    std::vector<Vec3> places;
    for (const LatticePlace& at : lattice_places(lattice_, points))
      places.push_back(scaled_place(lattice_, vector_of(at)));
    return places;
  }

  // From one of the cubes about a vertex to another over squares; without the last.
  void append_way(Cell vertex, std::uint32_t from, std::uint32_t to,
                  std::vector<std::uint32_t>& points) const {
    const auto star = complex_.star(vertex);
    std::array<std::uint32_t, 8> queue{to}, next_to{to};  // where the way from there leads on
    for (std::size_t n = 0, end = 1; queue[n] != from; ++n) {
      for (std::size_t side = 0; side < 6; ++side) {
        const std::uint32_t beside = complex_.neighbour(queue[n], side / 2, side % 2 == 0 ? 0 : 2);
        if (std::none_of(star.begin(), star.end(),
                         [&](const auto& member) { return member.cube == beside; }) ||
            std::find(queue.begin(), queue.begin() + end, beside) != queue.begin() + end)
          continue;
        next_to[end] = queue[n];
        queue[end++] = beside;
      }
    }
    for (std::uint32_t at = from; at != to;) {
      points.push_back(at);
      at = next_to[static_cast<std::size_t>(std::find(queue.begin(), queue.end(), at) - queue.begin())];
    }
  }

  const Lattice& lattice_;
  const DualComplex& complex_;
  std::span<const float> radius_;
  std::vector<std::vector<Vec3>> of_surface_;
};

// The lines that opened loops leave: from their open ends to what stays without them.
class OpenLines {
 public:
  // @param loose with the lines, `rest` without.
  OpenLines(const Lattice& lattice, const DualComplex& complex, const CellSet& loose, const CellSet& rest,
            std::span<const float> radius)
      : lattice_(lattice), complex_(complex), loose_(loose), rest_(rest), radius_(radius) {}

  // A line reaches as far as it goes on beyond the largest ball about where it begins.
  LimbTip tip_at(Cell end) const {
    const std::vector<Cell> line = line_to(end);
    const std::vector<Vec3> places = places_of_vertices(lattice_, line);
    const double ball = radius_at(line.front());
    const auto from = [&](std::size_t n) { return norm(places[n] - places.front()); };
    std::size_t root = 0;
    while (root + 1 < line.size() && from(root) < ball) ++root;
    const double width = radius_at(line[root]);
    const double length = from(line.size() - 1) - ball;
    return {end, width, width, length / std::max(width, kLeastWidth), length};
  }

 private:
  // Vertices from where it begins.
  std::vector<Cell> line_to(Cell end) const {
    std::unordered_map<Cell, Cell> next{{end, end}};  // towards the end
    std::vector<Cell> queue{end};
    std::size_t n = 0;
    for (; n < queue.size() && !rest_.has(queue[n]); ++n) {
      for (const Cell edge : complex_.cofaces(queue[n])) {
        if (!loose_.has(edge)) continue;
        complex_.for_each_face(edge, [&](Cell to) {
          if (next.try_emplace(to, queue[n]).second) queue.push_back(to);
        });
      }
    }
    std::vector<Cell> line{queue[std::min(n, queue.size() - 1)]};
    while (line.back() != end) line.push_back(next.at(line.back()));
    return line;
  }

  double radius_at(Cell vertex) const { return radius_about(complex_, radius_, vertex); }

  const Lattice& lattice_;
  const DualComplex& complex_;
  const CellSet &loose_, &rest_;
  std::span<const float> radius_;
};

}  // namespace

FilledTunnels fill_tunnels(const Solid& solid, const Lattice& lattice, const DualComplex& complex,
                           std::span<const Anchor> anchors, std::span<const float> radius, CellSet& left,
                           ExecutionContext* context) {
  if (solid.self_intersecting) return {};
  const CellSet graph = collapsed(complex, left, {}, context);
  bool encloses = false;
  graph.for_each([&](Cell cell) { encloses = encloses || DualComplex::dimension(cell) > 1; });
  if (encloses) return {};
  const auto loops = shortest_loops(complex, graph, kMostTunnels + 1, context);
  if (loops.size() > kMostTunnels || loops.size() <= betti_numbers(solid).holes) return {};
  const Tunnels tunnels(solid, lattice, complex, radius);
  std::vector<Cycle> cycles;
  for (const auto& loop : loops) cycles.push_back(tunnels.cycle_of(loop));
  cycles = Tunnels::bounding(std::move(cycles));
  const CellSet anchored = closure_of(complex, anchors);
  FilledTunnels filled;
  std::vector<Cell> ends;
  for (std::size_t n = 0; n < cycles.size(); ++n) {
    throw_if_stopped(context);
    const auto edge = tunnels.weakest_edge(cycles[n], left, anchored);
    if (!edge) continue;
    left.erase(*edge);
    filled.edges.push_back(*edge);
    complex.for_each_face(*edge, [&](Cell vertex) { ends.push_back(vertex); });
    for (std::size_t other = n + 1; other < cycles.size(); ++other)
      if (cycles[other].has(*edge)) cycles[other].add(cycles[n]);
  }
  if (filled.edges.empty()) return filled;
  const CellSet rest = collapsed(complex, left, anchors, context);
  const OpenLines lines(lattice, complex, left, rest, radius);
  std::vector<Anchor> stay(anchors.begin(), anchors.end());
  for (const Cell end : ends) {
    const LimbTip tip = lines.tip_at(end);
    if (tip.reach < RidgeConstants::limb_reach) continue;
    stay.push_back({end});
    filled.limbs.push_back(tip);
  }
  left = collapsed(complex, left, stay, context);
  return filled;
}

}  // namespace affskel::core
