#pragma once

#include <string_view>

#include "core/voxels/voxel_image.h"

namespace affskel::core {

/// Whether the bytes are an image of voxels of a kind that parse_voxels reads, told by their beginning.
bool is_voxel_image(std::string_view bytes);

/// Reads an image of voxels, with its numbers in the same file: NRRD (raw, gzip, text), MetaImage (.mha), NIfTI-1
/// (.nii).  Scalars of any type; what the file says of places (spacings, origin, directions) is kept.
/// @throws CoreError kBadInput, with the line for text.
VoxelImage parse_voxels(std::string_view bytes);

}  // namespace affskel::core
