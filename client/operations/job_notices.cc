#include "client/operations/job_notices.h"

#include "base/number_text.h"
#include "client/base/error.h"
#include "client/text/job_progress.h"
#include "client/text/job_text.h"
#include "client/text/summary_text.h"
#include "client/text/words.h"

namespace affskel::client {
namespace {

// By a server that says nothing of it.
Notice unexplained_empty_skeleton(const v1::Job& job) {
  Notice empty = warning("EMPTY_SKELETON", "the skeleton is empty: no |H| is above the threshold");
  if (job.prepared().points() < kCoarseLattice) {
    empty.message += ", and the lattice has only " + base::counted(job.prepared().points(), "point") +
                     " in the solid; submit again with a smaller spacing than " +
                     base::to_text(job.prepared().spacing());
    return empty;
  }
  v1::Setting& threshold = empty.to_try.emplace_back();
  threshold.set_name("threshold");
  threshold.set_value("3");
  return empty;
}

}  // namespace

Notices skeleton_notices(std::uint64_t items, const v1::SkeletonQuality& quality, const v1::Job& job) {
  if (quality.advice().empty()) {
    if (items > 0) return {};
    return {unexplained_empty_skeleton(job)};
  }
  Notice advice = items == 0 ? warning("EMPTY_SKELETON", "the skeleton is empty: " + quality.advice())
                             : warning("SKELETON", "the skeleton: " + quality.advice());
  advice.to_try.assign(quality.to_try().begin(), quality.to_try().end());
  return {advice};
}

Notices skeleton_notices(const v1::TriangleMesh& skeleton, const v1::Job& job) {
  return skeleton_notices(static_cast<std::uint64_t>(skeleton.xyz_size() / 3), skeleton.quality(), job);
}

Notices eroded_notices(const v1::TriangleMesh& eroded) {
  if (!eroded.corners().empty()) return {};
  return {warning("EMPTY_ERODED", "the eroded solid is empty: " + eroded.quality().advice())};
}

Notices end_notices(const v1::Job& job) {
  Notices notices = skeleton_notices(job.skeleton_points(), job.quality(), job);
  append(notices, job_warnings(job));
  return notices;
}

std::string unfinished_text(const v1::Job& job) {
  if (job.state() == v1::JOB_STATE_FAILED) return "failed: " + failure_text(job.error());
  const JobProgress progress = progress_of(job);
  const std::string done =
      std::to_string(progress.done) + " of " + std::to_string(progress.total) + " " + progress.unit;
  if (job.state() == v1::JOB_STATE_CANCELLED) return "was cancelled at " + done;
  return "is " + state_word(job.state()) + ": " + done + " are done";
}

v1::Job finished_job(Session& session, const std::string& name) {
  v1::Job job = session.get_job(name);
  if (job.state() == v1::JOB_STATE_DONE) return job;
  throw ClientError(ExitCode::kNotFound,
                    "there is nothing to show: job " + job.id() + " " + unfinished_text(job));
}

}  // namespace affskel::client
