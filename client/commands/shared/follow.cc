#include "client/commands/shared/follow.h"

#include <algorithm>

#include "client/cli/interrupt.h"
#include "client/cli/progress.h"
#include "client/commands/shared/notices.h"
#include "client/operations/job_notices.h"
#include "client/text/job_text.h"
#include "client/text/message_json.h"
#include "client/text/shell_quoted.h"
#include "client/text/summary_text.h"
#include "client/text/words.h"

namespace affskel::client {

v1::Job follow(Context& context, const std::string& job, bool stream, bool writes) {
  ProgressView view(context.console());
  std::string told_for;
  v1::Job last = context.session().watch(job, [&](const v1::Job& now) {
    if (told_for != now.id()) {
      told_for = now.id();
      set_interrupt_message(
          "\njob " + now.id() + " goes on; " +
          (writes ? "the same command again follows it and writes its files\n"
                  : "follow it again with: " + context.next_command("watch " + now.id()) + "\n"));
    }
    view.update(now);
    if (stream) context.console().document(to_json(now));
  });
  set_interrupt_message("");
  return last;
}

void show_state(Console& console, const v1::Job& job) {
  console.result(state_word(job.state()) + "\n");
  console.document(to_json(job));
}

void throw_unless_done(const Context& context, const v1::Job& job) {
  if (job.state() == v1::JOB_STATE_FAILED) {
    throw ClientError(ExitCode::kJobFailed, "job " + job.id() + " failed: " + failure_text(job.error()));
  }
  if (job.state() == v1::JOB_STATE_CANCELLED) {
    throw ClientError(ExitCode::kCancelled, "job " + job.id() + " was cancelled; go on with: " +
                                                context.next_command("resume " + job.id()));
  }
}

void show_end(Context& context, const v1::Job& job, const Notices& said) {
  throw_unless_done(context, job);
  Console& console = context.console();
  for (const Notice& notice : end_notices(job)) {
    const auto same = [&](const Notice& one) { return one.kind == notice.kind && one.code == notice.code; };
    if (std::none_of(said.begin(), said.end(), same)) say(console, notice);
  }
  console.note(summary_text(job));
  const std::string id = short_id(job), stem = file_stem(job.name());
  console.note("next: " + context.next_command("render " + id + " -o " + shell_quoted(stem + ".png")));
  console.note("      " + context.next_command("view " + id + " -o " + shell_quoted(stem + ".html")));
}

}  // namespace affskel::client
