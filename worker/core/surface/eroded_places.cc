#include "core/surface/eroded_places.h"

#include <algorithm>

namespace affskel::core {

void ErodedPlaces::Extent::take(std::int64_t low, std::int64_t high) {
  first = std::min(first, low);
  last = std::max(last, high);
}

ErodedPlaces::ErodedPlaces(const Lattice& lattice, const FrameField& field, const LatticeCuts& cuts,
                           double level)
    : lattice_(lattice), field_(field), cuts_(cuts), level_(level) {
  for (std::size_t a = 0; a < 3; ++a) dims_[a] = lattice.grid.dims[a];
  for (Layer& layer : layers_) {
    const auto size = static_cast<std::size_t>((dims_[1] + 2) * (dims_[2] + 2));
    layer.full.assign(size, 0);
    layer.gaps.assign(size, 0);
    layer.rows.resize(static_cast<std::size_t>(dims_[1] + 2));
  }
}

// Layer i is that of the call before; layers -1 and dims hold no sample points.
void ErodedPlaces::move_to(std::int64_t i) {
  Layer& next = layers_[slot(i + 1)];
  clear(next);
  if (i + 1 >= dims_[0]) return;
  fill_places(i + 1, next);
  fill_gaps(i + 1, next);
}

ErodedPlaces::Row ErodedPlaces::row(std::int64_t i, std::int64_t j) const {
  const Layer& layer = layers_[slot(i)];
  const std::size_t begin = in_layer(j, 0);
  return {layer.full.data() + begin, layer.gaps.data() + begin, layer.rows[static_cast<std::size_t>(j + 1)]};
}

std::size_t ErodedPlaces::in_layer(std::int64_t j, std::int64_t k) const {
  return static_cast<std::size_t>((j + 1) * (dims_[2] + 2) + (k + 1));
}

// Touches only what was filled: most of the box may be empty.
void ErodedPlaces::clear(Layer& filled) const {
  for (std::int64_t j = -1; j <= dims_[1]; ++j) {
    Extent& row = filled.rows[static_cast<std::size_t>(j + 1)];
    if (row.first > row.last) continue;
    const auto begin = filled.full.begin() + static_cast<std::ptrdiff_t>(in_layer(j, row.first));
    std::fill_n(begin, row.last - row.first + 1, std::uint8_t{0});
    row = {};
  }
  for (std::size_t n : filled.gap_places) filled.gaps[n] = 0;
  filled.gap_places.clear();
}

void ErodedPlaces::fill_places(std::int64_t i, Layer& filled) {
  const std::vector<LatticeRun>& runs = lattice_.axis[2].runs;
  for (; next_run_ < runs.size() && runs[next_run_].start[0] == i; ++next_run_) {
    const LatticeRun& run = runs[next_run_];
    const std::int64_t j = run.start[1];
    for (std::uint32_t n = 0; n < run.length; ++n) {
      if (!(field_.erosion[run.first + n] >= level_)) continue;
      const std::int64_t k = std::int64_t{run.start[2]} + n;
      filled.full[in_layer(j, k)] = 1;
      filled.rows[static_cast<std::size_t>(j + 1)].take(k, k);
    }
  }
}

void ErodedPlaces::fill_gaps(std::int64_t i, Layer& filled) {
  const std::uint64_t first = cuts_.edge(i, -1, -1, 0), end = cuts_.edge(i + 1, -1, -1, 0);
  const std::vector<LatticeCut>& all = cuts_.all();
  for (; next_cut_ < all.size() && all[next_cut_].edge < end; ++next_cut_) {
    const LatticeCut& cut = all[next_cut_];
    if (!cut.gap || cut.edge < first) continue;
    const auto n = static_cast<std::size_t>((cut.edge - first) / 8);
    if (filled.gaps[n] == 0) filled.gap_places.push_back(n);
    filled.gaps[n] |= static_cast<std::uint8_t>(1U << (cut.edge % 8));
  }
}

}  // namespace affskel::core
