#include "core/collapse/collapse.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/none.h"
#include "core/collapse/collapsing.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

// What is farthest from the anchors goes first.
class Order {
 public:
  Order(const DualComplex& complex, std::vector<float> way) : complex_(complex), way_(std::move(way)) {
    for (const float way_here : way_)
      if (way_here < kNoWay) farthest_ = std::max(farthest_, static_cast<double>(way_here));
  }

  Collapsing::Due due(Cell, Cell coface, double) const {
    const std::uint32_t cube = DualComplex::cube_of(coface), place = DualComplex::place_of(coface);
    double sum = static_cast<double>(way_[cube]), count = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t digit = DualComplex::digit(place, axis);
      const std::uint32_t beside = digit == 1 ? kNone : complex_.neighbour(cube, axis, digit);
      if (beside == kNone) continue;
      sum += static_cast<double>(way_[beside]);
      ++count;
    }
    return {std::max(0.0, farthest_ - sum / count)};
  }
  // Ways grow faster and faster towards the surface: lines slid along it, instead of coming off.
  double level(Cell cell) const {
    return -value_at<Continued::kAcrossBoundary>(
        complex_, cell, [&](std::uint32_t cube) { return static_cast<double>(way_[cube]); });
  }
  void removed(Cell, Cell, double, bool) {}

 private:
  const DualComplex& complex_;
  std::vector<float> way_;  // per cube, to the nearest anchor
  double farthest_ = 0;
};

// A square is no anchor any more, nor what of its boundary bounds no other.
// @param own anchors of other kinds, ascending.
void give_up(const DualComplex& complex, std::span<const Cell> own, Cell square, Collapsing& collapsing) {
  collapsing.release(square);
  const auto release = [&](Cell cell) {
    if (std::binary_search(own.begin(), own.end(), cell)) return;
    for (const Cell coface : complex.cofaces(cell))
      if (collapsing.is_fixed(coface)) return;
    collapsing.release(cell);
  };
  complex.for_each_face(square, release);
  complex.for_each_face(square, [&](Cell edge) { complex.for_each_face(edge, release); });
}

// What is free goes, in any order.
struct AnyOrder {
  static Collapsing::Due due(Cell, Cell, double) { return {}; }
  static double level(Cell) { return 0; }
  static void removed(Cell, Cell, double, bool) {}
};

}  // namespace

Collapsed collapse(const DualComplex& complex, std::span<const Anchor> anchors, CollapseOptions options) {
  Order order(complex, shortest_ways(complex, anchors, options.cost, options.context));
  std::vector<float>().swap(options.cost);  // the ways have what they say
  Collapsing collapsing(complex, options.context);
  std::vector<Cell> own;
  for (const Anchor& anchor : anchors) {
    if (DualComplex::dimension(anchor.cell) < 2) own.push_back(anchor.cell);
    collapsing.fix(anchor.cell);
  }
  std::sort(own.begin(), own.end());
  collapsing.run(order);
  std::vector<Anchor> walls;
  for (const Anchor& anchor : anchors)
    if (DualComplex::dimension(anchor.cell) == 2 && collapsing.cofaces(anchor.cell) > 0)
      walls.push_back(anchor);
  std::sort(walls.begin(), walls.end(), [](const Anchor& a, const Anchor& b) {
    return a.weight != b.weight ? a.weight < b.weight : a.cell < b.cell;
  });
  std::uint32_t opened = 0;
  // A square between two pockets waits until one of them is open.
  for (bool changed = true; changed;) {
    changed = false;
    for (const Anchor& wall : walls) {
      if (!collapsing.is_fixed(wall.cell) || collapsing.cofaces(wall.cell) != 1) continue;
      give_up(complex, own, wall.cell, collapsing);
      collapsing.run_from(wall.cell, order);
      ++opened;
      changed = true;
    }
  }
  return {collapsing.cells(), opened};
}

CellSet collapsed(const DualComplex& complex, const CellSet& cells, std::span<const Anchor> anchors,
                  ExecutionContext* context) {
  Collapsing collapsing(complex, cells, context);
  for (const Anchor& anchor : anchors)
    if (cells.has(anchor.cell)) collapsing.fix(anchor.cell);
  AnyOrder order;
  collapsing.run(order, cells);
  return collapsing.cells();
}

std::uint64_t count_components(const DualComplex& complex, const CellSet& cells) {
  std::unordered_map<Cell, std::uint32_t> number;  // of vertices
  cells.for_each([&](Cell cell) {
    if (DualComplex::dimension(cell) == 0) number.emplace(cell, static_cast<std::uint32_t>(number.size()));
  });
  DisjointSets sets(number.size());
  std::uint64_t components = number.size();
  cells.for_each([&](Cell cell) {
    if (DualComplex::dimension(cell) != 1) return;
    const auto [a, b] = complex.ends(cell);
    if (sets.unite(number.at(a), number.at(b))) --components;
  });
  return components;
}

}  // namespace affskel::core
