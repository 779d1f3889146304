#include "core/lattice/layer_index.h"

#include <algorithm>
#include <numeric>

namespace affskel::core {

LayerIndex::LayerIndex(const Lattice& lattice) : lattice_(lattice) {
  const auto& dims = lattice.grid.dims;
  for (auto& layer : layers_) layer.assign(std::size_t{dims[1]} * dims[2], kNone);
}

void LayerIndex::move_to(std::uint32_t i) {
  if (i == 0) fill(0);
  fill(i + 1);
}

void LayerIndex::fill(std::uint32_t i) {
  const std::vector<LatticeRun>& runs = lattice_.axis[2].runs;
  const auto begin_of = [&](const LatticeRun& run) {
    const std::size_t place = std::size_t{run.start[1]} * lattice_.grid.dims[2] + run.start[2];
    return layers_[i % 3].begin() + static_cast<std::ptrdiff_t>(place);
  };
  // Only what i - 3 left there is wiped out: most of the box may be empty.
  RunRange& filled = filled_[i % 3];
  for (std::size_t r = filled.first; r < filled.last; ++r) {
    std::fill_n(begin_of(runs[r]), runs[r].length, kNone);
  }
  filled.first = next_;
  for (; next_ < runs.size() && runs[next_].start[0] == i; ++next_) {
    const LatticeRun& run = runs[next_];
    std::iota(begin_of(run), begin_of(run) + run.length, run.first);
  }
  filled.last = next_;
}

}  // namespace affskel::core
