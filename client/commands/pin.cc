#include <memory>

#include "client/commands/commands.h"
#include "client/commands/shared/job_options.h"
#include "client/text/message_json.h"

namespace affskel::client {
namespace {

void run_pin(Context& context, const std::string& name) {
  const v1::Job job = context.session().pin(name);
  context.console().result("pinned\n");
  context.console().document(to_json(job));
}

}  // namespace

void add_pin(CommandLine& line) {
  const auto job = std::make_shared<std::string>();
  CLI::App* command =
      line.add("pin", "Keep a job and its results from being removed by age or lack of room",
               "  affskel-client pin @last", [job](Context& context) { run_pin(context, *job); });
  add_job(command, *job);
}

}  // namespace affskel::client
