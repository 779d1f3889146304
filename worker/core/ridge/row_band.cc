#include "core/ridge/row_band.h"

#include <algorithm>

#include "core/lattice/lattice_points.h"

namespace affskel::core {

// Margins are gone through from the widest down, a step at a time: what they ask for by then grows by that step.
template <class MarginOf>
RowBand::RowBand(const Lattice& lattice, std::int32_t widest, const MarginOf& margin_of)
    : margin_(widest),
      ends_{static_cast<std::int32_t>(lattice.grid.dims[0]) + widest,
            static_cast<std::int32_t>(lattice.grid.dims[1]) + widest},
      rows_(static_cast<std::size_t>(ends_[0] + widest) * static_cast<std::size_t>(ends_[1] + widest)) {
  struct Stretch {
    std::size_t row;
    std::int32_t begin, end;
  };
  std::vector<std::vector<Stretch>> of_margin(static_cast<std::size_t>(widest) + 1);
  for (const LatticeRun& run : lattice.axis[2].runs) {
    const std::size_t row =
        index(static_cast<std::int32_t>(run.start[0]), static_cast<std::int32_t>(run.start[1]));
    const auto place = [&](std::uint32_t n) { return static_cast<std::int32_t>(run.start[2] + n); };
    for (std::uint32_t begin = 0, end = 0; begin < run.length; begin = end) {
      const std::uint8_t margin = margin_of(run.first + begin);
      while (end < run.length && margin_of(run.first + end) == margin) ++end;
      of_margin[margin].push_back({row, place(begin), place(end)});
    }
  }
  for (std::size_t margin = of_margin.size(); margin-- > 0;) {
    for (const auto& [row, begin, end] : of_margin[margin]) rows_[row].include({begin, end});
    if (margin > 0) widen_by_one();
  }
  number_places();
}

RowBand::RowBand(const Lattice& lattice, std::uint8_t margin)
    : RowBand(lattice, margin, [&](std::uint32_t) { return margin; }) {}

RowBand::RowBand(const Lattice& lattice, std::span<const std::uint8_t> margin)
    : RowBand(lattice, margin.empty() ? 0 : *std::ranges::max_element(margin),
              [&](std::uint32_t p) { return margin[p]; }) {}

void RowBand::widen_by_one() {
  for (Row& row : rows_)
    if (!row.empty()) row = {row.begin - 1, row.end + 1};
  for (const std::size_t beside : {index(0, 1) - index(0, 0), index(1, 0) - index(0, 0)}) {
    const std::vector<Row> before = rows_;
    for (std::size_t n = 0; n < before.size(); ++n) {
      if (before[n].empty())
        continue;  // nor is one at the end of the other axis, which has no neighbour there
      rows_[n - beside].include(before[n]);
      rows_[n + beside].include(before[n]);
    }
  }
}

void RowBand::number_places() {
  std::int64_t next = 0;
  for (Row& row : rows_) {
    row.offset = next - row.begin;
    next += row.end - row.begin;
  }
  places_ = static_cast<std::size_t>(next);
}

std::vector<std::uint32_t> ranks_in(const RowBand& band, const Lattice& lattice) {
  std::vector<std::uint32_t> ranks(band.places(), kNone);
  for_each_point(lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
    ranks[static_cast<std::size_t>(band.at(i, j, k))] = rank;
  });
  return ranks;
}

}  // namespace affskel::core
