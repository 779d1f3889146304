#include "core/ridge/row_band.h"

#include <algorithm>
#include <limits>

#include "core/lattice/lattice_points.h"

namespace affskel::core {

RowBand::RowBand(const Lattice& lattice, std::int32_t margin)
    : margin_(margin),
      ends_{static_cast<std::int32_t>(lattice.grid.dims[0]) + margin,
            static_cast<std::int32_t>(lattice.grid.dims[1]) + margin} {
  constexpr std::int32_t kLow = std::numeric_limits<std::int32_t>::max();
  const auto width = static_cast<std::size_t>(ends_[1] + margin_);
  const std::size_t count = static_cast<std::size_t>(ends_[0] + margin_) * width;
  std::vector<Row> hull(count, Row{kLow, -kLow, 0});
  const auto widen = [](Row& row, const Row& by, std::int32_t steps) {
    row.begin = std::min(row.begin, by.begin == kLow ? kLow : by.begin - steps);
    row.end = std::max(row.end, by.begin == kLow ? -kLow : by.end + steps);
  };
  for (const LatticeRun& run : lattice.axis[2].runs) {
    const auto k = static_cast<std::int32_t>(run.start[2]);
    widen(hull[index(static_cast<std::int32_t>(run.start[0]), static_cast<std::int32_t>(run.start[1]))],
          {k, k + static_cast<std::int32_t>(run.length), 0}, margin);
  }
  // Along j, then along i.
  std::vector<Row> along_j(count, Row{kLow, -kLow, 0});
  for (std::int32_t i = 0; i < ends_[0] - margin_; ++i) {
    for (std::int32_t j = 0; j < ends_[1] - margin_; ++j) {
      const Row& by = hull[index(i, j)];
      if (by.begin == kLow) continue;
      for (std::int32_t m = -margin_; m <= margin_; ++m) widen(along_j[index(i, j + m)], by, 0);
    }
  }
  rows_.assign(count, Row{kLow, -kLow, 0});
  for (std::int32_t i = 0; i < ends_[0] - margin_; ++i) {
    for (std::int32_t j = -margin_; j < ends_[1]; ++j) {
      const Row& by = along_j[index(i, j)];
      if (by.begin == kLow) continue;
      for (std::int32_t m = -margin_; m <= margin_; ++m) widen(rows_[index(i + m, j)], by, 0);
    }
  }
  for (Row& row : rows_)
    if (row.begin == kLow) row = Row{};
  number_places();
}

RowBand::RowBand(const RowBand& wide, const std::vector<std::uint8_t>& wanted)
    : margin_(wide.margin_), ends_{wide.ends_[0], wide.ends_[1]}, rows_(wide.rows_) {
  for (Row& row : rows_) {
    const std::uint8_t* const at = wanted.data() + row.offset;
    while (!row.empty() && at[row.begin] == 0) ++row.begin;
    while (!row.empty() && at[row.end - 1] == 0) --row.end;
  }
  number_places();
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
