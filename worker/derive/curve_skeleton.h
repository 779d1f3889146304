#pragma once

#include "affskel/v1/types.pb.h"
#include "derive/finished_field.h"

namespace affskel::worker {

/// The curve skeleton: the vertices of its lines.
/// @throws core::CoreError for a wrong parameter.
v1::SkeletonPoints curve_skeleton(const FinishedField& field, const v1::SkeletonParams& params);

/// Its lines.  @throws core::CoreError for a wrong parameter.
v1::TriangleMesh curve_lines(const FinishedField& field, const v1::SurfaceParams& params);

}  // namespace affskel::worker
