#pragma once

#include <string>

#include "client/files/read/input_file.h"
#include "client/render/scene.h"

namespace affskel::client {

/// A mesh as it was read, sound or not: PNG bytes of its views, with every defect marked (up to 100,000 of a
/// kind) and counted in the legend.  Pass `look.cameras` and the background; without a triangle there is
/// nothing to draw.
/// @param name for the title. @throws ClientError kBadInput for a mesh without triangles.
std::string mesh_picture(const InputFile& input, const std::string& name, const RenderOptions& look);

/// The same to turn, see view_page; defects up to 20,000 of a kind.
std::string mesh_page(const InputFile& input, const std::string& name);

}  // namespace affskel::client
