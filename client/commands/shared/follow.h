#pragma once

#include <string>
#include <vector>

#include "client/commands/shared/context.h"

namespace affskel::client {

/// Follows the job to a final state, showing progress.
/// @param stream in JSON mode, print every state as a document of its own.
v1::Job follow(Context& context, const std::string& job, bool stream);

/// The result of a command that changed a job: its state, or in JSON mode all of it.
void show_state(Console& console, const v1::Job& job);

/// @throws ClientError kJobFailed with the reason, or kCancelled, unless the job is done.
void throw_unless_done(const Context& context, const v1::Job& job);

/// Ends a command that followed a job to its end: what to know of a done one, how long it took, what came
/// out, and the commands to look at it with; else as throw_unless_done().
/// @param told warnings of the mesh that were told before.
void tell_end(Context& context, const v1::Job& job, const std::vector<std::string>& told = {});

/// Warns when the skeleton has no points, with the likely reason and what to try.  Passes on the advice that
/// its quality holds.
void warn_about_skeleton(Context& context, std::uint64_t skeleton_points, const v1::SkeletonQuality& quality,
                         const v1::Job& job);

/// Warns when the surface of an eroded solid is empty, with the reason.
void warn_about_eroded(Context& context, const v1::TriangleMesh& eroded);

/// "failed: CODE: message", "was cancelled at 5 of 12 directions" or "is running: 5 of 12 directions are
/// done", for a job that does not have what was asked for.
std::string unfinished_text(const v1::Job& job);

/// A job to show, which must be done.  @throws ClientError kNotFound saying how far it is.
v1::Job finished_job(Context& context, const std::string& name);

}  // namespace affskel::client
