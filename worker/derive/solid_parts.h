#pragma once

#include "affskel/v1/types.pb.h"
#include "derive/finished_field.h"

namespace affskel::worker {

/// @param params of the operator `curve`.
v1::SolidParts solid_parts(const FinishedField& field, const v1::SkeletonParams& params);

}  // namespace affskel::worker
