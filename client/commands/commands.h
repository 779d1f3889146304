#pragma once

#include <string>

#include "client/commands/options.h"
#include "client/commands/shared/context.h"

namespace affskel::client {

/// The commands.  Each prints its results and throws ClientError when it fails; a job that ended badly is a
/// failure of the commands that wait for it.

void run_submit(Context& context, const SubmitOptions& options);
void run_list(Context& context, const ListOptions& options);
void run_status(Context& context, const JobOptions& options);
void run_watch(Context& context, const JobOptions& options);
void run_cancel(Context& context, const JobOptions& options);
void run_resume(Context& context, const JobOptions& options);
void run_delete(Context& context, const JobOptions& options);
void run_server_info(Context& context);
void run_fetch(Context& context, const JobOptions& options);
void run_skeleton(Context& context, const JobOptions& options);
void run_surface(Context& context, const JobOptions& options);
void run_erode(Context& context, const JobOptions& options);
void run_render(Context& context, const JobOptions& options);
void run_view(Context& context, const JobOptions& options);
/// Needs no server.
void run_inspect(Console& console, const std::string& file);
/// Needs no server.
void run_make(Console& console, const MakeOptions& options);
/// Needs no server.
void run_compare(Console& console, const CompareOptions& options);
/// Needs no server.
void run_transform(Console& console, const TransformOptions& options);
/// Needs no server.
void run_perturb(Console& console, const PerturbOptions& options);

}  // namespace affskel::client
