#include <memory>

#include "client/commands/commands.h"
#include "client/commands/shared/job_options.h"
#include "client/text/message_json.h"

namespace affskel::client {
namespace {

void run_unpin(Context& context, const std::string& name) {
  const v1::Job job = context.session().unpin(name);
  context.console().result("unpinned\n");
  context.console().document(to_json(job));
}

}  // namespace

void add_unpin(CommandLine& line) {
  const auto job = std::make_shared<std::string>();
  CLI::App* command =
      line.add("unpin", "Let a pinned job be removed when its time has come", "  affskel-client unpin @last",
               [job](Context& context) { run_unpin(context, *job); });
  add_job(command, *job);
}

}  // namespace affskel::client
