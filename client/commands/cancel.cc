#include "client/commands/commands.h"
#include "client/commands/job_command.h"
#include "client/commands/shared/follow.h"

namespace affskel::client {
namespace {

void run_cancel(Context& context, const std::string& name) {
  v1::Job job = context.session().cancel(name);
  if (!is_final(job.state())) {
    // Workers stop at their next report.
    job = follow(context, job.id(), false);
  }
  show_state(context.console(), job);
}

}  // namespace

void add_cancel(CommandLine& line) {
  add_job_command(line, "cancel", "Stop a job, keeping its progress", "  affskel-client cancel @last",
                  run_cancel);
}

}  // namespace affskel::client
