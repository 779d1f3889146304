#include <memory>

#include "client/commands/commands.h"
#include "client/commands/shared/follow.h"
#include "client/commands/shared/job_options.h"
#include "client/text/words.h"

namespace affskel::client {
namespace {

void run_watch(Context& context, const std::string& name) {
  const v1::Job job = follow(context, name, true);
  context.console().result(state_word(job.state()) + "\n");
  show_end(context, job);
}

}  // namespace

void add_watch(CommandLine& line) {
  const auto job = std::make_shared<std::string>();
  CLI::App* command = line.add("watch", "Follow a job to its end; prints the final state",
                               "  affskel-client watch @last\n  affskel-client --json watch 3f2a9c",
                               [job](Context& context) { run_watch(context, *job); });
  add_job(command, *job);
}

}  // namespace affskel::client
