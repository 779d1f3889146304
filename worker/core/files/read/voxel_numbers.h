#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/coding.h"
#include "core/base/vec3.h"
#include "core/files/read/voxel_parsers.h"
#include "core/voxels/voxel_image.h"

namespace affskel::core {

// What the parsers of images of voxels share.

inline constexpr const char* kInOneFile = "; write header and numbers into one file (.nrrd, .mha, .nii)";

/// A type of values in files: their size, and how they become numbers.
struct Scalar {
  std::size_t bytes;
  /// @param bytes as many as `values` need. @param swapped whether the most significant byte is first.
  void (*decode)(std::string_view bytes, bool swapped, std::vector<float>& values);
};

template <class Number>
void decode_values(std::string_view bytes, bool swapped, std::vector<float>& values) {
  std::array<char, sizeof(Number)> raw;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::copy_n(bytes.data() + i * sizeof(Number), sizeof(Number), raw.begin());
    if (swapped) std::reverse(raw.begin(), raw.end());
    values[i] = static_cast<float>(base::decode<Number>(raw.data()));
  }
}

template <class Number>
inline constexpr Scalar kScalar{sizeof(Number), decode_values<Number>};

/// How an image's values stand in a file.
struct Numbers {
  Scalar scalar = kScalar<std::uint8_t>;
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

/// The numbers that a header has in another file. @param line that names it.
/// @throws CoreError kBadInput when no file beside may be read or it would be in another folder; what `beside` throws.
std::string read_numbers_beside(const std::string& name, std::uint64_t line, const ReadBeside& beside);

bool is_nrrd(std::string_view bytes);
bool is_metaimage(std::string_view bytes);
bool is_nifti(std::string_view bytes);
VoxelImage parse_nrrd(std::string_view bytes, const ReadBeside& beside);
VoxelImage parse_metaimage(std::string_view bytes, const ReadBeside& beside);
VoxelImage parse_nifti(std::string_view bytes);

}  // namespace affskel::core
