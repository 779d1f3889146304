#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/packed_numbers.h"
#include "core/base/vec3.h"
#include "core/files/read/voxel_parsers.h"
#include "core/voxels/voxel_image.h"

namespace affskel::core {

// What the parsers of images of voxels share.

inline constexpr const char* kInOneFile = "; write header and numbers into one file (.nrrd, .mha, .nii)";

/// The number of voxels.
/// @throws CoreError kBadInput for an axis without any, kLimit for more than 2^30.
std::size_t voxels_of(const std::array<std::size_t, 3>& size);

/// The numbers of an image of `voxels`, in bytes of their own, or else in those that are seen, which must outlive them;
/// more may follow.
/// @throws CoreError kBadInput when there are too few.
base::PackedNumbers numbers_of(std::size_t voxels, std::string_view seen, std::optional<std::string> own,
                               const base::NumberKind& kind, bool big_endian);

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
