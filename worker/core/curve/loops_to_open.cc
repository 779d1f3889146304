#include "core/curve/loops_to_open.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/groups.h"
#include "core/base/parity_rows.h"

namespace affskel::core {
namespace {

using Windings = std::vector<double>;

void add(Windings& sum, const Windings& more, double sign) {
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += sign * more[k];
}

// Per vertex: how a forest winds from the root of its tree to there.
std::vector<Windings> along_forest(std::size_t vertices, std::span<const Segment> segments,
                                   std::span<const std::uint32_t> forest, std::size_t loops,
                                   const std::function<Windings(std::uint32_t)>& windings) {
  const Groups<std::uint32_t> at(vertices, [&](const auto& put) {
    for (const std::uint32_t s : forest)
      for (const std::uint32_t v : segments[s]) put(v, s);
  });
  std::vector<Windings> result(vertices);
  std::vector<std::uint32_t> row;
  for (std::uint32_t root = 0; root < vertices; ++root) {
    if (!result[root].empty()) continue;
    result[root].assign(loops, 0);
    row.assign(1, root);
    for (std::size_t n = 0; n < row.size(); ++n) {
      for (const std::uint32_t s : at[row[n]]) {
        const bool forth = segments[s][0] == row[n];
        const std::uint32_t to = segments[s][forth ? 1 : 0];
        if (!result[to].empty()) continue;
        result[to] = result[row[n]];
        add(result[to], windings(s), forth ? 1 : -1);
        row.push_back(to);
      }
    }
  }
  return result;
}

}  // namespace

std::vector<std::uint32_t> loops_to_open(std::size_t vertices, std::span<const Segment> segments,
                                         std::span<const double> value, std::size_t loops,
                                         const std::function<std::vector<double>(std::uint32_t)>& windings) {
  std::vector<std::uint32_t> order(segments.size()), forest, closing;
  for (std::uint32_t s = 0; s < order.size(); ++s) order[s] = s;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return value[a] > value[b]; });
  DisjointSets together(vertices);
  for (const std::uint32_t s : order)
    (together.unite(segments[s][0], segments[s][1]) ? forest : closing).push_back(s);
  if (loops > 0 && !closing.empty()) {
    const std::vector<Windings> to = along_forest(vertices, segments, forest, loops, windings);
    ParityRows kept;
    std::erase_if(closing, [&](std::uint32_t s) {
      Windings round = windings(s);
      add(round, to[segments[s][0]], 1);
      add(round, to[segments[s][1]], -1);
      ParityRow odd;
      for (std::uint32_t k = 0; k < round.size(); ++k)
        if (std::llround(round[k]) % 2 != 0) odd.push_back(k);
      return kept.add(std::move(odd));
    });
  }
  std::sort(closing.begin(), closing.end());
  return closing;
}

}  // namespace affskel::core
