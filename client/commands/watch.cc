#include "client/commands/commands.h"
#include "client/commands/job_command.h"
#include "client/commands/shared/follow.h"
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
  add_job_command(line, "watch", "Follow a job to its end; prints the final state",
                  "  affskel-client watch @last\n  affskel-client --json watch 3f2a9c", run_watch);
}

}  // namespace affskel::client
