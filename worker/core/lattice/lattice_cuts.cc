// Watertight scan conversion along the seven steps: a diagonal is an axis of a sheared grid of the same
// lattice.  A sheared grid of a long lattice has the square of its length in lines, so only those that the
// surface meets are kept.
#include "core/lattice/lattice_cuts.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/lattice/scan_conversion.h"

namespace affskel::core {
namespace {

using Indices = std::array<std::int64_t, 3>;

bool has_axis(unsigned step, std::size_t axis) {
  return ((step >> (2 - axis)) & 1U) != 0;
}

/// A grid of the same lattice in which a step lies along the axis `main`.  The places' coordinates along
/// the step's other axes are then less by the one along `main`, and shifted to start at 0.
struct ShearedGrid {
  LatticeGrid grid;
  std::size_t main = 0;
  std::array<bool, 3> sheared{};
  std::int64_t shift = 0;

  ShearedGrid(const LatticeGrid& lattice, unsigned step) : grid(lattice) {
    while (!has_axis(step, main)) ++main;
    shift = std::int64_t{lattice.dims[main]} - 1;
    for (std::size_t a = main + 1; a < 3; ++a) {
      sheared[a] = has_axis(step, a);
      if (!sheared[a]) continue;
      grid.axes[main] = grid.axes[main] + lattice.axes[a];
      grid.origin = grid.origin - static_cast<double>(shift) * lattice.axes[a];
      grid.dims[a] += lattice.dims[main] - 1;
    }
  }

  /// The place at coordinate `along` of line number `line` (as in LineCrossings).
  Indices place(std::uint64_t line, std::int64_t along) const {
    const std::size_t u = (main + 1) % 3, v = (main + 2) % 3;
    Indices at{};
    at[main] = along;
    at[u] = static_cast<std::int64_t>(line / grid.dims[v]);
    at[v] = static_cast<std::int64_t>(line % grid.dims[v]);
    for (std::size_t a = 0; a < 3; ++a) {
      if (sheared[a]) at[a] += along - shift;
    }
    return at;
  }
};

/// The crossings of one edge, whose lower end has coordinate `low` along its line and winding number
/// `winding`, which moves on to that of the upper end.
LatticeCut cut_of(std::span<const CrossingOnLine> crossings, double low, std::int32_t& winding) {
  LatticeCut cut;
  bool left = winding <= 0;
  if (left) cut.leaves = 0;
  for (std::size_t c = 0; c < crossings.size(); ++c) {
    const std::int32_t before = winding;
    winding -= crossings[c].crossing.exits;
    const double share = crossings[c].crossing.depth - low;
    if (winding <= 0 && !left) {
      cut.leaves = share;
      left = true;
    }
    if (winding > 0 && before <= 0) cut.enters = share;
    cut.gap = cut.gap || (winding <= 0 && c + 1 < crossings.size());
  }
  if (winding <= 0) cut.enters = 1;
  return cut;
}

}  // namespace

LatticeCuts::LatticeCuts(const Solid& solid, const Lattice& lattice, ExecutionContext* context) {
  for (std::size_t a = 0; a < 3; ++a) size_[a] = std::int64_t{lattice.grid.dims[a]} + 2;
  for (unsigned step = 1; step < 8; ++step) add_step(solid, lattice, step, context);
  std::sort(cuts_.begin(), cuts_.end(),
            [](const LatticeCut& a, const LatticeCut& b) { return a.edge < b.edge; });
}

void LatticeCuts::add_step(const Solid& solid, const Lattice& lattice, unsigned step,
                           ExecutionContext* context) {
  throw_if_stopped(context);
  const ShearedGrid sheared(lattice.grid, step);
  const std::vector<CrossingOnLine> found =
      scan_convert_lines_met(solid.mesh, sheared.grid, static_cast<int>(sheared.main), context);
  const auto in_reach = [&](const Indices& at) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (at[a] < (has_axis(step, a) ? -1 : 0) || at[a] > size_[a] - 3) return false;
    }
    return true;
  };
  std::int32_t winding = 0;
  for (std::size_t c = 0, next = 0; c < found.size(); c = next) {
    const std::uint64_t line = found[c].line;
    if (c == 0 || found[c - 1].line != line) winding = 0;
    // A crossing at a place belongs to the edge that ends there, as in the lattice's runs.
    const double low = std::ceil(found[c].crossing.depth) - 1;
    while (next < found.size() && found[next].line == line && found[next].crossing.depth <= low + 1) ++next;
    LatticeCut cut = cut_of({&found[c], next - c}, low, winding);
    const Indices at = sheared.place(line, static_cast<std::int64_t>(low));
    if (!in_reach(at)) continue;
    cut.edge = edge(at[0], at[1], at[2], step);
    cuts_.push_back(cut);
  }
}

const LatticeCut* LatticeCuts::find(std::uint64_t edge) const {
  const auto at = std::lower_bound(cuts_.begin(), cuts_.end(), edge,
                                   [](const LatticeCut& cut, std::uint64_t e) { return cut.edge < e; });
  return at != cuts_.end() && at->edge == edge ? &*at : nullptr;
}

}  // namespace affskel::core
