#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "core/voxels/voxel_image.h"

namespace affskel::core {

/// Whether the bytes are an image of voxels of a kind that parse_voxels reads, told by their beginning.
bool is_voxel_image(std::string_view bytes);

/// The bytes of a file in the folder that another is from, by its name, which has no folder; empty where a header must
/// not choose what is read.
using ReadBeside = std::function<std::string(const std::string& name)>;

/// Reads an image of voxels: NRRD (raw, gzip, text), MetaImage, both with their numbers in the same file or in one beside
/// it (.nhdr, .mhd), NIfTI-1 (.nii).  Scalars of any type; what the file says of places (spacings, origin, directions)
/// is kept.  Numbers that are not packed are seen in the bytes, which must outlive the image.
/// @throws CoreError kBadInput, with the line for text; kLimit for more than 2^30 voxels, and as unpack; what `beside`
///   throws.
VoxelImage parse_voxels(std::string_view bytes, const ReadBeside& beside = {});

}  // namespace affskel::core
