#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/base/vec3.h"
#include "core/voxels/voxel_image.h"

namespace affskel::core {

// What the parsers of images of voxels share.

inline constexpr const char* kInOneFile = "; write header and numbers into one file (.nrrd, .mha, .nii)";

/// Types of values in files.
enum class Scalar { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat, kDouble };

/// How an image's values stand in a file.
struct Numbers {
  Scalar scalar = Scalar::kUint8;
  bool big_endian = false;
  double scale = 1, offset = 0;
};

/// The number of voxels.
/// @throws CoreError kBadInput for an axis without any, kLimit for more than 2^30.
std::size_t voxels_of(const std::array<std::size_t, 3>& size);

/// Gives the image, whose size is set, its values.
/// @throws CoreError kBadInput when there are too few bytes; as voxels_of.
void take_numbers(std::string_view bytes, const Numbers& numbers, VoxelImage& image);

/// Three sizes; more axes only where they have one item.
/// @throws CoreError kBadInput with the line, 0 = none.
std::array<std::size_t, 3> sizes_of(const std::vector<double>& numbers, std::uint64_t line);

/// The place of a voxel by the steps from one to the next along each axis.
AffineMap place_of(const std::vector<Vec3>& steps, const Vec3& origin);

bool is_nrrd(std::string_view bytes);
bool is_metaimage(std::string_view bytes);
bool is_nifti(std::string_view bytes);
VoxelImage parse_nrrd(std::string_view bytes);
VoxelImage parse_metaimage(std::string_view bytes);
VoxelImage parse_nifti(std::string_view bytes);

}  // namespace affskel::core
