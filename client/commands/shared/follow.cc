#include "client/commands/shared/follow.h"

#include "base/number_text.h"
#include "client/cli/interrupt.h"
#include "client/cli/progress.h"
#include "client/text/job_text.h"
#include "client/text/message_json.h"
#include "client/text/words.h"

namespace affskel::client {

v1::Job follow(Context& context, const std::string& job, bool stream) {
  ProgressView view(context.console());
  std::string told_for;
  v1::Job last = context.session().watch(job, [&](const v1::Job& now) {
    if (told_for != now.id()) {
      told_for = now.id();
      set_interrupt_message("\njob " + now.id() + " goes on; follow it again with: affskel-client watch " +
                            now.id() + "\n");
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

void throw_unless_done(const v1::Job& job) {
  if (job.state() == v1::JOB_STATE_FAILED) {
    throw ClientError(ExitCode::kJobFailed, "job " + job.id() + " failed: " + failure_text(job.error()));
  }
  if (job.state() == v1::JOB_STATE_CANCELLED) {
    throw ClientError(ExitCode::kCancelled,
                      "job " + job.id() + " was cancelled; go on with: affskel-client resume " + job.id());
  }
}

void warn_about_skeleton(Console& console, std::uint64_t skeleton_points, const v1::SkeletonQuality& quality,
                         const v1::Job& job) {
  if (!quality.advice().empty()) {
    console.warning((skeleton_points == 0 ? "the skeleton is empty: " : "the skeleton: ") + quality.advice());
    return;
  }
  if (skeleton_points > 0) return;
  constexpr std::uint64_t kCoarse = 2000;  // below this a solid is only a few points thick
  const std::uint64_t points = job.prepared().points();
  const bool coarse = points < kCoarse;
  console.warning("the skeleton is empty: no |H| is above the threshold" +
                  (coarse ? ", and the lattice has only " + base::counted(points, "point") +
                                " in the solid; submit again with a smaller --spacing than " +
                                base::to_text(job.prepared().spacing())
                          : "; try: affskel-client skeleton " + job.id() + " --threshold 3 -o FILE"));
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
