#pragma once

#include <string>

#include "affskel/v1/types.pb.h"
#include "client/base/shape_file.h"

namespace affskel::client {

/// Parse a SKELETON and an ERODED_POINTS artefact (whose points have no H).
/// @throws ClientError kInternal when its arrays differ in length.
v1::SkeletonPoints parse_skeleton(const std::string& bytes);
v1::SkeletonPoints parse_eroded_points(const std::string& bytes);

/// The points as a table with the columns E, nx, ny, nz, direction (but of an infimum) and, but for points of an eroded solid, H.
ShapeFile shape_of(const v1::SkeletonPoints& points);

}  // namespace affskel::client
