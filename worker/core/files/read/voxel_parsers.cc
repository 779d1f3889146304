#include "core/files/read/voxel_parsers.h"

#include <cmath>

#include "core/files/read/voxel_numbers.h"
#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

void check_image(const VoxelImage& image) {
  for (std::size_t i = 0; i < image.numbers.size(); ++i)
    if (!std::isfinite(image.value(i))) fail_at(0, "the image holds values that are not finite");
  require_regular(image.place);
}

}  // namespace

bool is_voxel_image(std::string_view bytes) {
  return is_nrrd(bytes) || is_metaimage(bytes) || is_nifti(bytes);
}

VoxelImage parse_voxels(std::string_view bytes, const ReadBeside& beside) {
  VoxelImage image = is_nrrd(bytes)    ? parse_nrrd(bytes, beside)
                     : is_nifti(bytes) ? parse_nifti(bytes)
                                       : parse_metaimage(bytes, beside);
  check_image(image);
  return image;
}

}  // namespace affskel::core
