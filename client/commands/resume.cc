#include <memory>

#include "client/commands/commands.h"
#include "client/commands/shared/follow.h"
#include "client/commands/shared/job_options.h"

namespace affskel::client {
namespace {

void run(Context& context, const std::string& name) {
  show_state(context.console(), context.session().resume(name));
}

}  // namespace

void add_resume(CommandLine& line) {
  const auto job = std::make_shared<std::string>();
  CLI::App* command = line.add("resume", "Go on with a cancelled or failed job",
                               "  affskel-client resume @last && affskel-client watch @last",
                               [job](Context& context) { run(context, *job); });
  add_job(command, *job);
}

}  // namespace affskel::client
