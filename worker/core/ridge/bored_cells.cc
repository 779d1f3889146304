#include "core/ridge/bored_cells.h"

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/collapse/collapse.h"
#include "core/collapse/shortest_loops.h"
#include "core/contour/edge_cells.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

// What may go of what is left: `graph` is that, collapsed as far as it can be.
class Openings {
 public:
  Openings(const NoisySolid& solid, const CellSet& left, const CellSet& graph, const CellSet& keep)
      : solid_(solid), complex_(solid.complex), left_(left), graph_(graph), keep_(keep) {
    graph.for_each([&](Cell cell) {
      if (DualComplex::dimension(cell) == 2) squares_.push_back(cell);
    });
  }

  // Of each membrane, whose squares share edges, one.
  std::vector<Cell> squares() const {
    DisjointSets membranes(squares_.size());
    std::unordered_map<Cell, std::uint32_t> beside;  // per edge: a square
    for (std::uint32_t n = 0; n < squares_.size(); ++n) {
      complex_.for_each_face(squares_[n], [&](Cell edge) {
        const auto [known, fresh] = beside.try_emplace(edge, n);
        if (!fresh) membranes.unite(n, known->second);
      });
    }
    std::map<std::uint32_t, WeakestCell> weakest;  // by membrane
    for (std::uint32_t n = 0; n < squares_.size(); ++n) look_at(squares_[n], weakest[membranes.find(n)]);
    std::vector<Cell> result;
    for (const auto& [membrane, found] : weakest)
      if (found.cell) result.push_back(*found.cell);
    return result;
  }

  std::vector<Cell> edges(ExecutionContext* context) const {
    const auto loops = shortest_loops(complex_, graph_, kMostBored + 1, context);
    std::vector<Cell> result;
    if (loops.size() > kMostBored) return result;
    std::unordered_set<Cell> passed;
    for (std::size_t n = 0; n + solid_.handles < loops.size(); ++n) {
      const auto& [vertices, edges] = loops[n];
      if (!is_bored(vertices) ||
          std::any_of(vertices.begin(), vertices.end(), [&](Cell v) { return passed.contains(v); }))
        continue;
      WeakestCell weakest;
      for (const Cell edge : edges)
        if (is_bare(complex_, edge, left_)) look_at(edge, weakest);
      if (!weakest.cell) continue;
      result.push_back(*weakest.cell);
      passed.insert(vertices.begin(), vertices.end());
    }
    return result;
  }

 private:
  void look_at(Cell cell, WeakestCell& weakest) const {
    if (!keep_.has(cell)) weakest.look_at(complex_, solid_.radius, cell);
  }

  bool is_bored(const std::vector<Cell>& loop) const {
    const std::vector<Vec3> places = places_of_vertices(solid_.lattice, loop);
    for (std::size_t n = 0; n < loop.size(); ++n) {
      const double reach = kBored * radius_about(complex_, solid_.thickness, loop[n]);
      if (std::all_of(places.begin(), places.end(),
                      [&](const Vec3& p) { return norm(p - places[n]) <= reach; }))
        return true;
    }
    return false;
  }

  const NoisySolid& solid_;
  const DualComplex& complex_;
  const CellSet &left_, &graph_, &keep_;
  std::vector<Cell> squares_;
};

}  // namespace

BoredCells bored_cells(const NoisySolid& solid, const CellSet& left, std::span<const Anchor> anchors,
                       ExecutionContext* context) {
  const DualComplex& complex = solid.complex;
  const CellSet keep = closure_of(complex, anchors);
  BoredCells result{{}, left, CellSet(complex)};
  while (true) {
    result.graph = collapsed(complex, result.left, {}, context);
    const Openings openings(solid, result.left, result.graph, keep);
    std::vector<Cell> cells = openings.squares();
    if (cells.empty()) cells = openings.edges(context);
    if (cells.empty()) return result;
    for (const Cell cell : cells) result.left.erase(cell);
    result.left = collapsed(complex, result.left, anchors, context);
    result.cells.insert(result.cells.end(), cells.begin(), cells.end());
  }
}

BettiNumbers fill_bored(const NoisySolid& solid, const BettiNumbers& before, std::span<const Anchor> anchors,
                        CellSet& left, ExecutionContext* context) {
  BoredCells bored = bored_cells(solid, left, anchors, context);
  if (bored.cells.empty()) return before;
  left = std::move(bored.left);
  // Counted: a square that has one void on both sides bounds none, and leaves a loop when it goes.
  std::array<std::uint64_t, 3> count{};
  bored.graph.for_each([&](Cell cell) { ++count[static_cast<std::size_t>(DualComplex::dimension(cell))]; });
  BettiNumbers after = before;
  const auto squares = static_cast<std::uint64_t>(std::count_if(
      bored.cells.begin(), bored.cells.end(), [](Cell cell) { return DualComplex::dimension(cell) == 2; }));
  after.cavities = count[2] == 0 ? 0 : before.cavities - std::min(before.cavities, squares);
  // Euler and Poincare; fragments beside have neither loops nor voids.
  after.holes =
      count_components(solid.complex, bored.graph) + after.cavities + count[1] - count[0] - count[2];
  return after;
}

}  // namespace affskel::core
