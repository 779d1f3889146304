#include <memory>

#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/follow.h"
#include "client/commands/shared/job_options.h"

namespace affskel::client {
namespace {

struct ResumeOptions {
  std::string job;
  std::string distrust;
};

void run_resume(Context& context, const ResumeOptions& options) {
  const v1::Job job = context.session().resume(options.job, options.distrust);
  if (!options.distrust.empty()) {
    context.console().note(
        "no more work goes there: not to a worker under its id, nor to any of a host until"
        " affskel-server trust names it; workers of the server's own then come back when it is started anew."
        " Look after the machine before");
  }
  show_state(context.console(), job);
}

}  // namespace

void add_resume(CommandLine& line) {
  const auto options = std::make_shared<ResumeOptions>();
  CLI::App* command = line.add("resume", "Go on with a cancelled or failed job",
                               "  affskel-client resume @last && affskel-client watch @last\n"
                               "  affskel-client resume 3f2a9c --distrust 0b1c2d3e4f5a",
                               [options](Context& context) { run_resume(context, *options); });
  add_job(command, options->job);
  command
      ->add_option(
          "--distrust", options->distrust,
          "Have what this worker (or all workers of this host) gave computed again by others, in whatever"
          " state the job is, and give it no more work (a host's workers: until affskel-server trust names"
          " it); for administrators, see verify")
      ->check(non_empty())
      ->check(utf8_text())
      ->type_name("WORKER");
}

}  // namespace affskel::client
