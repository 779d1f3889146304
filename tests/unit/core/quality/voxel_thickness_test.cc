#include "core/quality/voxel_thickness.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace affskel::core {
namespace {

using Places = std::vector<LatticePlace>;

// 12 x 12 x `layers` voxels, the layers along `axis`.
Places plate(std::size_t axis, std::uint32_t layers) {
  Places voxels;
  for (std::uint32_t a = 0; a < layers; ++a) {
    for (std::uint32_t u = 0; u < 12; ++u) {
      for (std::uint32_t v = 0; v < 12; ++v) {
        LatticePlace p{};
        p[axis] = a + 5;
        p[(axis + 1) % 3] = u;
        p[(axis + 2) % 3] = v;
        voxels.push_back(p);
      }
    }
  }
  std::sort(voxels.begin(), voxels.end());
  return voxels;
}

TEST(VoxelThickness, CountsTheLayersOfAPlateAlongEveryAxis) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const std::uint32_t layers : {1U, 2U, 3U})
      EXPECT_EQ(mean_voxel_thickness(plate(axis, layers)), layers);
  }
}

// A digital plane z = floor(x / 2 + y / 3): one voxel per line along z, thick or thin as one stacks it.
TEST(VoxelThickness, CountsTheLayersOfASlantedPlane) {
  for (const std::uint32_t layers : {1U, 2U}) {
    Places voxels;
    for (std::uint32_t i = 0; i < 18; ++i) {
      for (std::uint32_t j = 0; j < 18; ++j) {
        for (std::uint32_t a = 0; a < layers; ++a) voxels.push_back({i, j, (3 * i + 2 * j) / 6 + a});
      }
    }
    EXPECT_NEAR(mean_voxel_thickness(voxels), layers, 0.1);  // lines along x and y end at the rim
  }
}

TEST(VoxelThickness, OfACurveAndOfNothing) {
  EXPECT_EQ(mean_voxel_thickness(Places{{0, 0, 0}, {0, 1, 1}, {0, 2, 1}, {1, 3, 1}, {1, 3, 2}}), 1);
  EXPECT_EQ(mean_voxel_thickness({}), 0);
}

// Half the sheet one voxel thick and half three: 4 voxels for every 2 of a layer.
TEST(VoxelThickness, IsVoxelsPerLayer) {
  Places voxels;
  for (const LatticePlace& p : plate(2, 3)) {
    if (p[2] == 6 || p[0] < 6) voxels.push_back(p);
  }
  EXPECT_DOUBLE_EQ(mean_voxel_thickness(voxels), 2);
}

}  // namespace
}  // namespace affskel::core
