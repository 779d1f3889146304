#pragma once

#include <string>

#include "affskel/v1/types.pb.h"

namespace affskel::wire {

/// |H| above which the Zucker-Hummel operator keeps a point: the published threshold.
inline constexpr double kZuckerHummelThreshold = 7.0;

/// Canonical forms: defaults filled in, the direction set spelled in one way, so that equal requests are
/// equal messages.  Idempotent.
/// @throws std::invalid_argument, with a message for people, when a value is out of its range.
v1::ErosionParams canonical(const v1::ErosionParams& params);
v1::SkeletonParams canonical(const v1::SkeletonParams& params);
v1::SurfaceParams canonical(const v1::SurfaceParams& params);

/// Keys of canonical parameters: equal exactly when the results are equal.  Doubles enter with all bits.
std::string cache_key(const v1::ErosionParams& params);
std::string cache_key(const v1::SkeletonParams& params);
std::string cache_key(const v1::SurfaceParams& params);

}  // namespace affskel::wire
