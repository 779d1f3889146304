#include <chrono>
#include <memory>
#include <thread>

#include "base/number_text.h"
#include "client/cli/interrupt.h"
#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/job_options.h"
#include "client/text/message_json.h"
#include "client/text/printable.h"
#include "client/text/shell_quoted.h"
#include "client/text/verification_text.h"

namespace affskel::client {
namespace {

constexpr auto kPause = std::chrono::milliseconds(500);

struct VerifyOptions {
  std::string job;
  double share = 0.01;
};

/// Asks until nothing more will happen; tells once why it waits.
v1::Verification follow_verification(Context& context, const VerifyOptions& options) {
  v1::Verification verification = context.session().verify(options.job, options.share, 0);
  const std::string again = "verify " + verification.job() + " --share " + base::to_text(options.share);
  set_interrupt_message("\nthe verification goes on; follow it again with: " + context.next_command(again) +
                        "\n");
  std::string told;
  while (!verification.finished()) {
    if (const std::string& why = verification.waiting_reason(); !why.empty() && why != told) {
      context.console().note("waits: " + why);
      told = why;
    }
    std::this_thread::sleep_for(kPause);
    verification = context.session().verify(verification.job(), options.share, verification.id());
  }
  set_interrupt_message("");
  return verification;
}

void run_verify(Context& context, const VerifyOptions& options) {
  const v1::Verification verification = follow_verification(context, options);
  context.console().result(verification_details(verification));
  context.console().document(to_json(verification));
  if (context.session().get_job(verification.job()).params().minimum() == v1::MINIMUM_INFIMUM)
    context.console().note("the directions are verified, where the refinement began; what came of it is not");
  if (const v1::VerifiedSample* sample = first_differing(verification)) {
    std::string why = difference_text(*sample);
    if (sample->givers_size() > 0)
      why += "; have it computed again with: " +
             context.next_command("resume " + verification.job() + " --distrust " +
                                  shell_quoted(one_line(sample->givers(0).worker())));
    throw ClientError(ExitCode::kJobFailed, why);
  }
  if (const std::string why = gap_text(verification); !why.empty()) {
    throw ClientError(ExitCode::kCancelled, why);
  }
}

}  // namespace

void add_verify(CommandLine& line) {
  const auto options = std::make_shared<VerifyOptions>();
  CLI::App* command =
      line.add("verify", "Have a sample of a job's field computed again by other workers, and compare",
               "  affskel-client verify @last\n  affskel-client verify 3f2a9c --share 10%",
               [options](Context& context) { run_verify(context, *options); });
  add_job(command, options->job);
  command
      ->add_option("--share", options->share, "Of each worker's directions; at least one is computed again")
      ->transform(share_or_all())
      ->default_str("1%")
      ->type_name("P%");
}

}  // namespace affskel::client
