#pragma once

#include "affskel/v1/types.pb.h"
#include "derive/finished_field.h"

namespace affskel::worker {

/// The skeleton as the ridge of E: the vertices of its sheet.
/// @throws core::CoreError for a wrong parameter.
v1::SkeletonPoints ridge_skeleton(const FinishedField& field, const v1::SkeletonParams& params);

/// That sheet, with barriers where they are asked for.  @throws core::CoreError for a wrong parameter.
v1::TriangleMesh ridge_sheet(const FinishedField& field, const v1::SurfaceParams& params);

}  // namespace affskel::worker
