#include "database/errors.h"
#include "store/store_impl.h"
#include "store/task_leases.h"
#include "store/verification.h"
#include "wire/field_record.h"
#include "wire/limits.h"
#include "wire/words.h"

namespace affskel::server {
namespace {

constexpr double kUsualShare = 0.01;

void require_done(const JobRow& job) {
  if (job.state == v1::JOB_STATE_DONE && job.removed_ms == 0) return;
  throw StoreError(StoreError::Code::kPrecondition,
                   "job " + job.id +
                       (job.removed_ms > 0 ? ": its results were removed" : " is " + wire::word(job.state)) +
                       ", and only the field of a job that is done can be verified");
}

/// A sample is a field of its own, and a result.
void require_sample_room(const JobRow& job) {
  constexpr auto kMostPoints = static_cast<std::int64_t>(wire::kMaxResultBytes / wire::kFieldRecordBytes);
  if (job.points <= kMostPoints) return;
  throw StoreError(StoreError::Code::kLimit, "job " + job.id + " has " + std::to_string(job.points) +
                                                 " points; fields of at most " + std::to_string(kMostPoints) +
                                                 " can be verified");
}

}  // namespace

v1::Verification Store::verify(const JobRef& job_ref, double share, std::int64_t verification) {
  if (!(share >= 0 && share <= 1)) {
    throw StoreError(StoreError::Code::kInvalid, "the share of directions to verify must be 0 .. 1");
  }
  if (verification != 0) {
    return read(
        [&](Database& db) { return verification_message(db, resolve_job(db, job_ref), verification); });
  }
  JobRow job;
  std::vector<Sample> samples;
  const std::int64_t present = read([&](Database& db) {
    job = get_job(db, resolve_job(db, job_ref));
    if (const std::int64_t running = verification_under_way(db, job.id)) return running;
    require_done(job);
    require_sample_room(job);
    // Reads the whole field: not while all others wait to write.
    samples = choose_samples(db, job, share == 0 ? kUsualShare : share);
    return std::int64_t{0};
  });
  return write([&](Tx& tx) {
    std::int64_t id = present != 0 ? present : verification_under_way(tx.db, job.id);
    if (id == 0) {
      const JobRow now = get_job(tx.db, job.id);
      require_done(now);
      if (now.erosion_id != job.erosion_id) {
        throw StoreError(StoreError::Code::kPrecondition,
                         "the field of job " + job.id + " has changed: again");
      }
      tx.require_room();
      id = begin_verification(tx, now, samples);
    }
    return verification_message(tx.db, job.id, id);
  });
}

v1::ReportResponse Store::complete_sample(const std::string& token, std::string_view fresh) {
  // The field of a job that is done does not change; when it was made anew meanwhile, the task is gone.
  const std::optional<SampleResult> result = read([&](Database& db) {
    const TaskRow task = task_of_token(db, token);
    return task.state == "done" ? std::nullopt : std::optional(compare_sample(db, task, fresh));
  });
  return write([&](Tx& tx) {
    const TaskRow task = held_task(tx, token);
    if (task.state == "done" || !result) return reply(false);
    finish_sample(tx, task, *result);
    finish_task(tx, task);
    return reply(false);
  });
}

}  // namespace affskel::server
