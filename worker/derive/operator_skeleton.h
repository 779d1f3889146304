#pragma once

#include "affskel/v1/types.pb.h"
#include "derive/finished_field.h"

namespace affskel::worker {

/// The skeleton by a differential operator: sample points with |H| above the threshold.
/// @throws core::CoreError for a wrong parameter.
v1::SkeletonPoints operator_skeleton(const FinishedField& field, const v1::SkeletonParams& params);

/// The alpha shape of that skeleton's points, taken in the lattice's frame.
/// @throws core::CoreError for a wrong parameter.
v1::TriangleMesh operator_surface(const FinishedField& field, const v1::SurfaceParams& params);

/// H at every sample point: little-endian doubles.  @throws core::CoreError kLimit when these are too many.
std::string operator_divergence(const FinishedField& field, v1::Operator which);

}  // namespace affskel::worker
