#include <memory>

#include "client/commands/commands.h"
#include "client/commands/shared/follow.h"
#include "client/commands/shared/job_options.h"

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
  const auto job = std::make_shared<std::string>();
  CLI::App* command = line.add("cancel", "Stop a job, keeping its progress", "  affskel-client cancel @last",
                               [job](Context& context) { run_cancel(context, *job); });
  add_job(command, *job);
}

}  // namespace affskel::client
