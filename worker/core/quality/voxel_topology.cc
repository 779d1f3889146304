#include "core/quality/voxel_topology.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"

// Notation.  A row is all places (i, j, *); a run is a maximal sequence of voxels of a row, a gap a maximal
// sequence of background.  Rows are numbered within the voxels' bounding box, i and j from 0; rows beside the
// box are empty.

namespace affskel::core {
namespace {

struct Run {
  std::int64_t first, last;  // k, inclusive
};

// The runs of all rows of the bounding box.
class Rows {
 public:
  explicit Rows(std::span<const LatticePlace> voxels) {
    std::array<std::uint32_t, 2> low = {voxels[0][0], voxels[0][1]}, high = low;
    for (const LatticePlace& v : voxels) {
      for (std::size_t a = 0; a < 2; ++a) {
        low[a] = std::min(low[a], v[a]);
        high[a] = std::max(high[a], v[a]);
      }
    }
    side_ = {std::int64_t{high[0]} - low[0] + 1, std::int64_t{high[1]} - low[1] + 1};
    begin_.assign(static_cast<std::size_t>(side_[0] * side_[1]) + 1, 0);
    for (const LatticePlace& v : voxels) {
      const std::size_t row = number(std::int64_t{v[0]} - low[0], std::int64_t{v[1]} - low[1]);
      const bool goes_on = begin_[row + 1] != 0 && runs_.back().last + 1 == v[2];
      if (goes_on) {
        ++runs_.back().last;
      } else {
        runs_.push_back({v[2], v[2]});
      }
      begin_[row + 1] = static_cast<std::uint32_t>(runs_.size());
    }
    // Empty rows end where the row before them does.
    for (std::size_t row = 1; row < begin_.size(); ++row)
      begin_[row] = std::max(begin_[row], begin_[row - 1]);
  }

  std::int64_t side(int axis) const { return side_[static_cast<std::size_t>(axis)]; }
  const std::vector<Run>& runs() const { return runs_; }

  // Half-open range of the row's runs; empty beside the box.
  std::pair<std::uint32_t, std::uint32_t> range(std::int64_t i, std::int64_t j) const {
    if (i < 0 || j < 0 || i >= side_[0] || j >= side_[1]) return {0, 0};
    return {begin_[number(i, j)], begin_[number(i, j) + 1]};
  }

 private:
  std::size_t number(std::int64_t i, std::int64_t j) const {
    return static_cast<std::size_t>(i * side_[1] + j);
  }

  std::array<std::int64_t, 2> side_{};
  std::vector<std::uint32_t> begin_;  // per row, and one past the end
  std::vector<Run> runs_;
};

template <class Visit>
void for_each_row(const Rows& rows, Visit visit) {
  for (std::int64_t i = 0; i < rows.side(0); ++i) {
    for (std::int64_t j = 0; j < rows.side(1); ++j) visit(i, j);
  }
}

// Voxels that share a corner are connected.
std::uint64_t count_components(const Rows& rows) {
  const std::vector<Run>& runs = rows.runs();
  DisjointSets sets(runs.size());
  std::uint64_t count = runs.size();
  for_each_row(rows, [&](std::int64_t i, std::int64_t j) {
    const auto [begin, end] = rows.range(i, j);
    for (const auto& [di, dj] : {std::pair{0, -1}, {-1, -1}, {-1, 0}, {-1, 1}}) {
      auto [b, b_end] = rows.range(i + di, j + dj);
      for (std::uint32_t a = begin; a != end && b != b_end;) {
        const bool touch = runs[a].first <= runs[b].last + 1 && runs[b].first <= runs[a].last + 1;
        if (touch) count -= sets.unite(a, b);
        runs[a].last < runs[b].last ? ++a : ++b;
      }
    }
  });
  return count;
}

// Background voxels that share a face are connected.  The gap before run r has number r; what reaches to
// infinity is one component, with the number of runs as its number.
class Background {
 public:
  explicit Background(const Rows& rows) : rows_(rows), sets_(rows.runs().size() + 1) {}

  // Components but for the infinite one.
  std::uint64_t count_bounded() {
    for_each_row(rows_, [&](std::int64_t i, std::int64_t j) {
      const auto [begin, end] = rows_.range(i, j);
      if (begin != end) bounded_ += end - begin - 1;
    });
    for_each_row(rows_, [&](std::int64_t i, std::int64_t j) {
      join(rows_.range(i, j), rows_.range(i - 1, j));
      join(rows_.range(i, j), rows_.range(i, j - 1));
      if (i + 1 == rows_.side(0)) join(rows_.range(i, j), {0, 0});
      if (j + 1 == rows_.side(1)) join(rows_.range(i, j), {0, 0});
    });
    return bounded_;
  }

 private:
  using Range = std::pair<std::uint32_t, std::uint32_t>;

  // Gap number `g` of a row, 0 .. number of its runs: its index in sets_ and its interval.
  struct Gap {
    std::uint32_t set;
    std::int64_t first, last;
  };
  Gap gap(const Range& row, std::uint32_t g) const {
    constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max();
    const std::vector<Run>& runs = rows_.runs();
    const std::uint32_t count = row.second - row.first;
    const std::int64_t first = g == 0 ? -kFar : runs[row.first + g - 1].last + 1;
    const std::int64_t last = g == count ? kFar : runs[row.first + g].first - 1;
    const bool infinite = g == 0 || g == count;
    return {infinite ? static_cast<std::uint32_t>(runs.size()) : row.first + g, first, last};
  }

  void join(const Range& row, const Range& other) {
    std::uint32_t a = 0, b = 0;
    while (a <= row.second - row.first && b <= other.second - other.first) {
      const Gap p = gap(row, a), q = gap(other, b);
      if (p.first <= q.last && q.first <= p.last) bounded_ -= sets_.unite(p.set, q.set);
      p.last < q.last ? ++a : ++b;
    }
  }

  const Rows& rows_;
  DisjointSets sets_;
  std::uint64_t bounded_ = 0;
};

// The complex is taken apart by what its cells are in i and j: over a vertex, an edge or a square of the (i,
// j) plane lie the voxels' closed intervals in k, united over the rows round it.  A union of closed intervals
// has one vertex more than edges per component.
class EulerCharacteristic {
 public:
  explicit EulerCharacteristic(const Rows& rows) : rows_(rows) {}

  std::int64_t value() {
    std::int64_t sum = 0;
    for (std::int64_t i = 0; i <= rows_.side(0); ++i) {
      for (std::int64_t j = 0; j <= rows_.side(1); ++j) {
        sum += components({{i - 1, j - 1}, {i - 1, j}, {i, j - 1}, {i, j}});  // vertices
        sum -= components({{i, j - 1}, {i, j}});                              // edges along i
        sum -= components({{i - 1, j}, {i, j}});                              // edges along j
        sum += components({{i, j}});                                          // squares
      }
    }
    return sum;
  }

 private:
  std::int64_t components(std::initializer_list<std::pair<std::int64_t, std::int64_t>> around) {
    stretches_.clear();
    for (const auto& [i, j] : around) {
      const auto [begin, end] = rows_.range(i, j);
      stretches_.insert(stretches_.end(), rows_.runs().begin() + begin, rows_.runs().begin() + end);
    }
    if (around.size() > 1) {
      std::sort(stretches_.begin(), stretches_.end(),
                [](const Run& a, const Run& b) { return a.first < b.first; });
    }
    std::int64_t count = 0, reached = std::numeric_limits<std::int64_t>::min();
    for (const Run& run : stretches_) {
      count += run.first > reached;
      reached = std::max(reached, run.last + 1);
    }
    return count;
  }

  const Rows& rows_;
  std::vector<Run> stretches_;
};

}  // namespace

BettiNumbers voxel_betti_numbers(std::span<const LatticePlace> voxels) {
  if (voxels.empty()) return {};
  const Rows rows(voxels);
  BettiNumbers numbers;
  numbers.components = count_components(rows);
  numbers.cavities = Background(rows).count_bounded();
  const std::int64_t euler = EulerCharacteristic(rows).value();
  numbers.holes = static_cast<std::uint64_t>(static_cast<std::int64_t>(numbers.components) +
                                             static_cast<std::int64_t>(numbers.cavities) - euler);
  return numbers;
}

}  // namespace affskel::core
