#include "client/commands/shared/follow.h"

#include <algorithm>

#include "base/number_text.h"
#include "client/cli/interrupt.h"
#include "client/cli/progress.h"
#include "client/text/job_text.h"
#include "client/text/message_json.h"
#include "client/text/shell_quoted.h"
#include "client/text/summary_text.h"
#include "client/text/words.h"

namespace affskel::client {

v1::Job follow(Context& context, const std::string& job, bool stream) {
  ProgressView view(context.console());
  std::string told_for;
  v1::Job last = context.session().watch(job, [&](const v1::Job& now) {
    if (told_for != now.id()) {
      told_for = now.id();
      set_interrupt_message("\njob " + now.id() + " goes on; follow it again with: " +
                            context.next_command("watch " + now.id()) + "\n");
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

void warn_about_eroded(Context& context, const v1::TriangleMesh& eroded) {
  if (eroded.corners().empty())
    context.console().warning("the eroded solid is empty: " + eroded.quality().advice());
}

void warn_about_skeleton(Context& context, std::uint64_t skeleton_points, const v1::SkeletonQuality& quality,
                         const v1::Job& job) {
  Console& console = context.console();
  if (!quality.advice().empty()) {
    console.warning((skeleton_points == 0 ? "the skeleton is empty: " : "the skeleton: ") + quality.advice());
    return;
  }
  if (skeleton_points > 0) return;
  const std::uint64_t points = job.prepared().points();
  const bool coarse = points < kCoarseLattice;
  console.warning(
      "the skeleton is empty: no |H| is above the threshold" +
      (coarse ? ", and the lattice has only " + base::counted(points, "point") +
                    " in the solid; submit again with a smaller --spacing than " +
                    base::to_text(job.prepared().spacing())
              : "; try: " + context.next_command("skeleton " + job.id() + " --threshold 3 -o FILE")));
}

void tell_end(Context& context, const v1::Job& job, const std::vector<std::string>& told) {
  throw_unless_done(context, job);
  Console& console = context.console();
  warn_about_skeleton(context, job.skeleton_points(), job.quality(), job);
  for (const std::string& warning : job_warnings(job)) {
    if (std::find(told.begin(), told.end(), warning) == told.end()) console.warning(warning);
  }
  console.note(summary_text(job));
  const std::string id = short_id(job), stem = file_stem(job.name());
  console.note("next: " + context.next_command("render " + id + " -o " + shell_quoted(stem + ".png")));
  console.note("      " + context.next_command("view " + id + " -o " + shell_quoted(stem + ".html")));
}

std::string unfinished_text(const v1::Job& job) {
  if (job.state() == v1::JOB_STATE_FAILED) return "failed: " + failure_text(job.error());
  const std::string done =
      std::to_string(job.directions_done()) + " of " + std::to_string(job.directions_total()) + " directions";
  if (job.state() == v1::JOB_STATE_CANCELLED) return "was cancelled at " + done;
  return "is " + state_word(job.state()) + ": " + done + " are done";
}

v1::Job finished_job(Context& context, const std::string& name) {
  v1::Job job = context.session().get_job(name);
  if (job.state() == v1::JOB_STATE_DONE) return job;
  throw ClientError(ExitCode::kNotFound,
                    "there is nothing to show: job " + job.id() + " " + unfinished_text(job));
}

}  // namespace affskel::client
