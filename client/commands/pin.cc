#include "client/commands/commands.h"
#include "client/commands/job_command.h"
#include "client/text/message_json.h"

namespace affskel::client {
namespace {

void run_pin(Context& context, const std::string& name) {
  const v1::Job job = context.session().pin(name);
  context.console().result("pinned\n");
  context.console().document(to_json(job));
}

void run_unpin(Context& context, const std::string& name) {
  const v1::Job job = context.session().unpin(name);
  context.console().result("unpinned\n");
  context.console().document(to_json(job));
}

}  // namespace

void add_pin(CommandLine& line) {
  add_job_command(line, "pin", "Keep a job and its results from being removed by age or lack of room",
                  "  affskel-client pin @last", run_pin);
}

void add_unpin(CommandLine& line) {
  add_job_command(line, "unpin", "Let a pinned job be removed when its time has come",
                  "  affskel-client unpin @last", run_unpin);
}

}  // namespace affskel::client
