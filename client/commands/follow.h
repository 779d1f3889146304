#pragma once

#include "client/commands/context.h"
#include "client/options.h"

namespace affskel::client {

/// Follows the job to a final state, showing progress.
/// @param stream in JSON mode, print every state as a document of its own.
v1::Job follow(Context& context, const std::string& job, bool stream);

/// @throws ClientError kJobFailed with the reason, or kCancelled, unless the job is done.
void throw_unless_done(const v1::Job& job);

/// Warns, with the likely reason and what to try, when the skeleton has no points; says what else its
/// quality gives reason to say.
void warn_if_empty(Console& console, std::uint64_t skeleton_points, const v1::SkeletonQuality& quality,
                   const v1::Job& job);

/// The message for the operator's name. @throws ClientError kUsage for an unknown one.
v1::SkeletonParams skeleton_params(const SkeletonOptions& options);

}  // namespace affskel::client
