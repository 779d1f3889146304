// b0 by union-find over the vertices; b2 is the dimension of the closed
// surfaces modulo 2. Triangles joined through edges of exactly two are taken as one patch, so that b2 is the
// number of patches less the rank of the conditions that rims and branches put on them; b1 follows from V - E
// + F.
#include "core/quality/sheet_topology.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/base/parity_rows.h"
#include "core/mesh/edges.h"

namespace affskel::core {
namespace {

using Segments = std::span<const Segment>;
using Sides = std::span<const EdgeSide>;

class Sheet {
 public:
  Sheet(const Mesh& sheet, Segments segments)
      : sheet_(sheet),
        segments_(segments),
        edges_(sheet.points.size(), sheet.triangles),
        joined_(sheet.points.size()),
        patches_(sheet.triangles.size()) {}

  BettiNumbers run() {
    std::int64_t edges = 0;
    edges_.for_each([&](std::uint32_t low, std::uint32_t high, Sides sides) {
      ++edges;
      joined_.unite(low, high);
      if (sides.size() == 2) patches_.unite(sides[0].triangle(), sides[1].triangle());
    });
    edges += join_segments();
    BettiNumbers result;
    for (std::uint32_t v = 0; v < sheet_.points.size(); ++v) result.components += joined_.find(v) == v;
    result.cavities = count_closed_surfaces();
    const std::int64_t euler = std::ssize(sheet_.points) - edges + std::ssize(sheet_.triangles);
    result.holes =
        static_cast<std::uint64_t>(static_cast<std::int64_t>(result.components + result.cavities) - euler);
    return result;
  }

 private:
  // Joins the ends of segments; the number of those that are no edges of triangles, each taken once.
  std::int64_t join_segments() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> own;
    for (const auto& [a, b] : segments_) {
      joined_.unite(a, b);
      if (edges_.between(a, b).empty()) own.emplace_back(std::minmax(a, b));
    }
    std::sort(own.begin(), own.end());
    return std::unique(own.begin(), own.end()) - own.begin();
  }

  // A closed surface is a set of patches that every edge meets an even number of times: none with a rim, and
  // one condition per branch edge.
  std::uint64_t count_closed_surfaces() {
    std::vector<bool> open(sheet_.triangles.size(), false);
    edges_.for_each([&](std::uint32_t, std::uint32_t, Sides sides) {
      if (sides.size() == 1) open[patches_.find(sides[0].triangle())] = true;
    });
    std::uint64_t closed = 0;
    for (std::uint32_t t = 0; t < open.size(); ++t) closed += patches_.find(t) == t && !open[t];
    std::vector<ParityRow> conditions;
    edges_.for_each([&](std::uint32_t, std::uint32_t, Sides sides) {
      if (sides.size() <= 2) return;
      ParityRow condition;
      for (const EdgeSide& side : sides) {
        const std::uint32_t patch = patches_.find(side.triangle());
        if (!open[patch]) condition = parity_sum(condition, {patch});
      }
      if (!condition.empty()) conditions.push_back(std::move(condition));
    });
    std::sort(conditions.begin(), conditions.end());
    conditions.erase(std::unique(conditions.begin(), conditions.end()), conditions.end());
    ParityRows rows;
    for (ParityRow& condition : conditions) rows.add(std::move(condition));
    return closed - rows.rank();
  }

  const Mesh& sheet_;
  Segments segments_;
  Edges edges_;
  DisjointSets joined_, patches_;
};

}  // namespace

BettiNumbers sheet_betti_numbers(const Mesh& sheet, std::span<const Segment> segments) {
  return Sheet(sheet, segments).run();
}

}  // namespace affskel::core
