#pragma once

#include <string_view>

#include "affskel/v1/types.pb.h"
#include "prepared_job.h"

namespace affskel::worker {

/// The thresholded skeleton of a finished field (`stored`: see ARTIFACT_KIND_FIELD).
/// @throws core::CoreError for a wrong parameter.
v1::SkeletonPoints derive_skeleton(const PreparedJob& job, std::string_view stored,
                                   const v1::SkeletonParams& params);

/// The alpha shape of that skeleton.  @throws core::CoreError for a wrong parameter.
v1::TriangleMesh derive_surface(const PreparedJob& job, std::string_view stored,
                                const v1::SurfaceParams& params);

}  // namespace affskel::worker
