#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/none.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// Which sample point stands at lattice place (i, j, k), for three neighbouring layers of constant i at a
/// time: an index of the whole box would be far larger than the solid.  For algorithms that walk over a
/// lattice and look at the 26 neighbours.  Keeps a reference to the lattice.
class LayerIndex {
 public:
  explicit LayerIndex(const Lattice& lattice);

  /// Makes i - 1, i and i + 1 available; i must grow by one from call to call, starting at 0.
  void move_to(std::uint32_t i);

  /// Rank of the sample point, or kNone; i as made available, j and k may lie outside the lattice's box.
  std::uint32_t at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    const auto& dims = lattice_.grid.dims;
    if (i < 0 || j < 0 || k < 0 || i >= dims[0] || j >= dims[1] || k >= dims[2]) return kNone;
    return layers_[static_cast<std::size_t>(i) % 3][static_cast<std::size_t>(j * dims[2] + k)];
  }

 private:
  struct RunRange {
    std::size_t first = 0, last = 0;  // of the runs along axis 2, one past the end
  };

  void fill(std::uint32_t i);

  const Lattice& lattice_;
  std::array<std::vector<std::uint32_t>, 3> layers_;
  std::array<RunRange, 3> filled_{};  // what stands in each layer
  std::size_t next_ = 0;
};

}  // namespace affskel::core
