#include "client/commands/commands.h"
#include "client/commands/job_command.h"
#include "client/text/job_text.h"
#include "client/text/message_json.h"

namespace affskel::client {
namespace {

void run_status(Context& context, const std::string& name) {
  const v1::Job job = context.session().get_job(name);
  context.console().result(job_details(job, context.console().style().out_colour));
  context.console().document(to_json(job));
}

}  // namespace

void add_status(CommandLine& line) {
  add_job_command(line, "status", "State, progress and facts of a job",
                  "  affskel-client status @last\n  affskel-client --json status 3f2a9c", run_status);
}

}  // namespace affskel::client
