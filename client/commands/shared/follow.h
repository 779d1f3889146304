#pragma once

#include <string>

#include "client/base/notice.h"
#include "client/commands/shared/context.h"

namespace affskel::client {

/// Follows the job to a final state, showing progress.
/// @param stream in JSON mode, print every state as a document of its own.
/// @param writes files at the end, of which a person who interrupts is told.
v1::Job follow(Context& context, const std::string& job, bool stream, bool writes = false);

/// The result of a command that changed a job: its state, or in JSON mode all of it.
void show_state(Console& console, const v1::Job& job);

/// @throws ClientError kJobFailed with the reason, or kCancelled, unless the job is done.
void throw_unless_done(const Context& context, const v1::Job& job);

/// Ends a command that followed a job to its end: what to know of a done one, how long it took, what came
/// out, and the commands to look at it with; else as throw_unless_done().
/// @param said of the mesh before.
void show_end(Context& context, const v1::Job& job, const Notices& said = {});

}  // namespace affskel::client
