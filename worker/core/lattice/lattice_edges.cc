#include "core/lattice/lattice_edges.h"

#include <algorithm>
#include <iterator>

namespace affskel::core {

std::optional<std::array<std::uint32_t, 2>> ends_of_edge(const Lattice& lattice, std::uint8_t axis,
                                                         const std::array<std::uint32_t, 3>& place) {
  const AxisRuns& along = lattice.axis[axis];
  // The order of the runs: line by line, and along each.
  const auto key = [u = (axis + 1U) % 3, v = (axis + 2U) % 3, axis](const std::array<std::uint32_t, 3>& at) {
    return std::array{at[u], at[v], at[axis]};
  };
  const auto next =
      std::upper_bound(along.runs.begin(), along.runs.end(), place,
                       [&](const auto& at, const LatticeRun& run) { return key(at) < key(run.start); });
  if (next == along.runs.begin()) return {};
  const LatticeRun& run = *std::prev(next);
  const auto [u, v, w] = key(place);
  const auto [run_u, run_v, run_w] = key(run.start);
  if (u != run_u || v != run_v || w - run_w >= run.length) return {};
  const std::uint32_t n = run.first + (w - run_w);
  const bool last = n + 1 == run.first + run.length;
  if (last && (next == along.runs.end() || !continues_in(run, *next, axis))) return {};
  if (along.order.empty()) return std::array{n, n + 1};
  return std::array{along.order[n], along.order[n + 1]};
}

}  // namespace affskel::core
