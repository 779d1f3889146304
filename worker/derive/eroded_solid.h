#pragma once

#include "affskel/v1/types.pb.h"
#include "derive/finished_field.h"

namespace affskel::worker {

/// The sample points of the eroded solid.
v1::SkeletonPoints eroded_points(const FinishedField& field, const v1::ErodedParams& params);

/// Its closed surface, with the volume it encloses.
v1::TriangleMesh eroded_surface(const FinishedField& field, const v1::ErodedParams& params);

}  // namespace affskel::worker
