#pragma once

#include <array>
#include <cstddef>

#include "base/packed_numbers.h"
#include "core/base/affine_map.h"

namespace affskel::core {

/// An image of voxels: one value at each place of a grid, as scanners give it: offset + scale * number, which is finite.
struct VoxelImage {
  std::array<std::size_t, 3> size{};  ///< voxels along the axes, each >= 1
  AffineMap place;                    ///< of a voxel by its indices, in the file's units
  base::PackedNumbers numbers;        ///< the first index runs fastest
  double scale = 1, offset = 0;

  double value(std::size_t voxel) const { return offset + scale * numbers[voxel]; }
  double at(std::size_t i, std::size_t j, std::size_t k) const {
    return value((k * size[1] + j) * size[0] + i);
  }
};

}  // namespace affskel::core
