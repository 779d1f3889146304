#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/base/affine_map.h"

namespace affskel::core {

/// An image of voxels: one value at each place of a grid, as scanners give it.
struct VoxelImage {
  std::array<std::size_t, 3> size{};  ///< voxels along the axes, each >= 1
  AffineMap place;                    ///< of a voxel by its indices, in the file's units
  std::vector<float> values;          ///< finite; the first index runs fastest

  float at(std::size_t i, std::size_t j, std::size_t k) const {
    return values[(k * size[1] + j) * size[0] + i];
  }
};

}  // namespace affskel::core
