#include "core/slab_index.h"

#include <algorithm>

namespace affskel::core {

SlabIndex::SlabIndex(const Lattice& lattice) : lattice_(lattice) {
  const auto& dims = lattice.frame.dims;
  for (auto& slab : slabs_) slab.assign(std::size_t{dims[1]} * dims[2], kOutside);
}

void SlabIndex::move_to(std::uint32_t i) {
  if (i == 0) fill(0);
  fill(i + 1);
}

void SlabIndex::fill(std::uint32_t i) {
  auto& slab = slabs_[i % 3];
  std::fill(slab.begin(), slab.end(), kOutside);
  const std::vector<LatticeRun>& runs = lattice_.axis[2].runs;
  for (; next_ < runs.size() && runs[next_].start[0] == i; ++next_) {
    const LatticeRun& run = runs[next_];
    const std::size_t row = std::size_t{run.start[1]} * lattice_.frame.dims[2] + run.start[2];
    for (std::uint32_t n = 0; n < run.length; ++n) slab[row + n] = run.first + n;
  }
}

}  // namespace affskel::core
