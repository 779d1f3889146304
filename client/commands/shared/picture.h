#pragma once

#include <string>

#include "client/commands/shared/context.h"
#include "client/commands/shared/skeleton_options.h"

namespace affskel::client {

/// The picture of a finished job: the body with its skeleton as points, of `chords` with its sheet.  Fetches
/// what it needs, and warns when there is no skeleton.
/// @param width pixels, see RenderOptions.  @return the bytes of a PNG file.
std::string job_picture(Context& context, const v1::Job& job, const SkeletonOptions& skeleton, int width);

}  // namespace affskel::client
