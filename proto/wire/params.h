#pragma once

#include <string>
#include <string_view>

#include "affskel/v1/types.pb.h"

namespace affskel::wire {

/// Level of an eroded solid when none is asked for, as a share of v0.
inline constexpr double kErodedFraction = 0.1;

/// What finds the skeleton when no operator is asked for.
inline constexpr v1::Operator kDefaultOperator = v1::OPERATOR_RIDGE;

/// The one spelling of a direction set (see Sampling's `directions`): no blanks, no leading zeros; empty is
/// "triangles".
/// @throws std::invalid_argument, naming the part and what is wrong with it.
std::string canonical_directions(std::string_view text);

/// Canonical forms: defaults filled in, the direction set spelled in one way, so that equal requests are
/// equal messages.  Idempotent.
/// @throws std::invalid_argument, with a message for people, when a value is out of its range.
v1::ErosionParams canonical(const v1::ErosionParams& params);
v1::SkeletonParams canonical(const v1::SkeletonParams& params);
v1::SurfaceParams canonical(const v1::SurfaceParams& params);
v1::ErodedParams canonical(const v1::ErodedParams& params);

/// Whether the operator gives a sheet or lines of its own, and no H = div n: `chords`, `ridge` and `curve`.
bool gives_sheet(v1::Operator which);

/// Of a job with this operator the one whose divergence is meant when none is named: the same, or for a sheet, which
/// has none, the published one.
v1::Operator usual_divergence(v1::Operator of_job);

/// What of canonical skeleton parameters the operator's divergence is a function of.
/// @throws std::invalid_argument for operators that give a sheet, which have none.
v1::SkeletonParams divergence_params(const v1::SkeletonParams& params);

/// Keys of canonical parameters: equal keys, equal results.  Doubles enter with all bits.
std::string cache_key(const v1::ErosionParams& params);
std::string cache_key(const v1::SkeletonParams& params);
std::string cache_key(const v1::SurfaceParams& params);
std::string cache_key(const v1::ErodedParams& params);

}  // namespace affskel::wire
