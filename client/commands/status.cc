#include <memory>

#include "client/commands/commands.h"
#include "client/commands/shared/job_options.h"
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
  const auto job = std::make_shared<std::string>();
  CLI::App* command = line.add("status", "State, progress and facts of a job",
                               "  affskel-client status @last\n  affskel-client --json status 3f2a9c",
                               [job](Context& context) { run_status(context, *job); });
  add_job(command, *job);
}

}  // namespace affskel::client
