#include <set>

#include "expect_store_error.h"
#include "store_fixture.h"
#include "wire/direction_order.h"
#include "wire/field_record.h"

namespace affskel::server {
namespace {

constexpr std::uint32_t kPoints = 300, kDirections = 64;

class VerifyTest : public StoreTest {
 protected:
  /// Blocks in turn by two workers, the other tasks by the first.
  v1::Job done_by_two() {
    const v1::Job job = submit();
    prepare(kPoints, kDirections);
    for (bool first = true;; first = !first) {
      const v1::Lease block = lease(first ? "worker-a" : "worker-b");
      if (block.kind() != v1::TASK_KIND_ERODE) {
        store_->complete(derive_header(block.token(), "skeleton", 3), "skeleton");
        return store_->job(job.id());
      }
      finish_block(block);
    }
  }

  /// The result of a VERIFY lease, `lowered` by so much at the first point.
  static std::string sample_field(const v1::Lease& lease, double lowered = 0) {
    std::string bytes(kPoints * wire::kFieldRecordBytes, '\0');
    for (std::uint32_t point = 0; point < kPoints; ++point) {
      wire::FieldRecord best;
      for (const v1::PositionRange& range : lease.positions()) {
        for (std::uint64_t p = range.begin(); p < range.end(); ++p) {
          const auto d = static_cast<std::uint32_t>(
              wire::direction_at(p, lease.job().order_stride(), lease.job().directions_total()));
          const double erosion = made_up_erosion(point, d);
          if (erosion < best.erosion || (erosion == best.erosion && d < best.direction)) {
            best = {erosion, made_up_area(point, d), d};
          }
        }
      }
      if (point == 0) best.erosion -= lowered;
      wire::encode_field_record(bytes.data() + point * wire::kFieldRecordBytes, best);
    }
    return bytes;
  }

  void verify_all(const std::string& worker, double lowered = 0) {
    while (true) {
      const std::optional<v1::Lease> sample = store_->lease(worker_identity(worker), "", false);
      if (!sample) return;
      ASSERT_EQ(sample->kind(), v1::TASK_KIND_VERIFY);
      const std::string data = sample_field(*sample, lowered);
      store_->complete(derive_header(sample->token(), data, kPoints), data);
    }
  }

  std::int64_t count(const char* sql) const {
    Database db(database(), Database::Mode::kReadOnly);
    return db.integer(sql).value_or(0);
  }
};

TEST_F(VerifyTest, KeepsWhoGaveWhat) {
  const v1::Job job = done_by_two();
  const v1::ListJobEventsResponse log = store_->events(job.id(), 0);
  ASSERT_EQ(log.givers_size(), 2);
  EXPECT_EQ(log.givers(0).worker(), "worker-a");
  EXPECT_EQ(log.givers(0).directions() + log.givers(1).directions(), kDirections);
}

// What was told of a direction that was never called done counts, too.
TEST_F(VerifyTest, RecordsCountAsGiven) {
  const v1::Job job = submit();
  prepare(kPoints, kDirections);
  const v1::Lease block = lease();
  report(block, {}, made_up_records(block.job(), 60, 62));
  EXPECT_EQ(count("SELECT first_position * 100 + end_position FROM given_ranges"), 6062);
}

TEST_F(VerifyTest, EveryWorkersPartIsComputedByAnother) {
  const v1::Job job = done_by_two();
  const v1::Verification begun = store_->verify(job.id(), 0.1, 0);
  EXPECT_FALSE(begun.finished());
  EXPECT_EQ(store_->verify(job.id(), 0.5, 0).id(), begun.id()) << "one at a time";
  verify_all("worker-a");
  v1::Verification seen = store_->verify(job.id(), 0, static_cast<std::int64_t>(begun.id()));
  EXPECT_FALSE(seen.finished()) << "nobody judges himself";
  open();
  clock_.advance(60'000);
  store_->expire_leases();
  verify_all("worker-b");
  seen = store_->verify(job.id(), 0, static_cast<std::int64_t>(begun.id()));
  EXPECT_TRUE(seen.finished());
  for (const v1::VerifiedSample& sample : seen.samples()) {
    EXPECT_EQ(sample.differing(), 0U) << sample.message();
    EXPECT_FALSE(sample.failed());
    EXPECT_NE(sample.givers(0).worker(), sample.verifier().worker());
    EXPECT_GT(sample.compared(), 0U);
  }
}

TEST_F(VerifyTest, AllOfItIsComparedToTheByte) {
  const v1::Job job = done_by_two();
  const v1::Verification begun = store_->verify(job.id(), 1, 0);
  verify_all("worker-c");
  const v1::Verification seen = store_->verify(job.id(), 0, static_cast<std::int64_t>(begun.id()));
  std::uint64_t compared = 0, directions = 0;
  for (const v1::VerifiedSample& sample : seen.samples()) {
    compared += sample.compared();
    directions += sample.directions();
  }
  EXPECT_EQ(compared, kPoints) << "every stored value comes from one of all directions";
  EXPECT_EQ(directions, kDirections);
}

TEST_F(VerifyTest, ASmallerValueThanTheStoredOneIsADifference) {
  const v1::Job job = done_by_two();
  const v1::Verification begun = store_->verify(job.id(), 1, 0);
  verify_all("worker-c", 1.0);
  const v1::Verification seen = store_->verify(job.id(), 0, static_cast<std::int64_t>(begun.id()));
  for (const v1::VerifiedSample& sample : seen.samples()) EXPECT_EQ(sample.differing(), 1U);
}

// Numbers of tasks are given again: the next one must not bring a cancelled verification back to life.
TEST_F(VerifyTest, WhatIsCancelledStaysSo) {
  const v1::Job job = done_by_two();
  const v1::Verification begun = store_->verify(job.id(), 1, 0);
  const std::int64_t next = count("SELECT max(id) + 1 FROM tasks");
  store_->cancel(job.id());
  EXPECT_EQ(count("SELECT count(*) FROM samples WHERE state = 'pending'"), 0);
  for (int i = 0; count("SELECT max(id) FROM tasks") < next; ++i) {
    submit("OFF again " + std::to_string(i), "again");
  }
  const v1::Verification seen = store_->verify(job.id(), 0, static_cast<std::int64_t>(begun.id()));
  EXPECT_TRUE(seen.finished());
  for (const v1::VerifiedSample& sample : seen.samples()) EXPECT_EQ(sample.message(), "cancelled");
  EXPECT_NE(store_->verify(job.id(), 1, 0).id(), 0U);
}

// Those that an earlier server left pending.
TEST_F(VerifyTest, AnotherTaskIsNotTakenForThatOfASample) {
  const v1::Job job = done_by_two();
  const v1::Verification begun = store_->verify(job.id(), 1, 0);
  store_->cancel(job.id());
  Database(database(), Database::Mode::kReadWrite).execute("UPDATE samples SET state = 'pending'");
  const std::int64_t reused = count("SELECT min(task_id) FROM samples");
  for (int i = 0; count("SELECT max(id) FROM tasks") < reused; ++i) {
    submit("OFF again " + std::to_string(i), "again");
  }
  EXPECT_TRUE(store_->verify(job.id(), 0, static_cast<std::int64_t>(begun.id())).finished());
  EXPECT_GT(store_->verify(job.id(), 1, 0).samples_size(), 0);
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_DONE);
}

// Its worker could not hand it in, and would compute it again and again.
TEST_F(VerifyTest, WhatNoResultCanHoldIsRefusedBeforehand) {
  const v1::Job job = done_by_two();
  Database(database(), Database::Mode::kReadWrite).execute("UPDATE erosions SET points = 107374183");
  EXPECT_STORE_ERROR(store_->verify(job.id(), 0, 0), kLimit);
}

TEST_F(VerifyTest, OnlyDoneJobsAreVerified) {
  const v1::Job job = submit();
  EXPECT_STORE_ERROR(store_->verify(job.id(), 0, 0), kPrecondition);
  EXPECT_STORE_ERROR(store_->verify(job.id(), 1.5, 0), kInvalid);
  EXPECT_STORE_ERROR(store_->verify(job.id(), 0, 7), kNotFound);
}

TEST_F(VerifyTest, DistrustComputesAgainAndGivesNoMoreWork) {
  const v1::Job job = done_by_two();
  const v1::Lease before = [&] {
    submit("OFF 2", "another");
    return lease("worker-b");
  }();
  EXPECT_STORE_ERROR(store_->resume_without(job.id(), "nobody"), kNotFound);
  const v1::Job again = store_->resume_without(job.id(), "worker-b");
  EXPECT_EQ(again.state(), v1::JOB_STATE_QUEUED);
  EXPECT_EQ(again.stage(), v1::JOB_STAGE_ERODE);
  EXPECT_STORE_ERROR(store_->lease(worker_identity("worker-b"), "", false), kForbidden);
  EXPECT_STORE_ERROR(store_->renew(before.token()), kFenced);
  while (true) {
    const v1::Lease task = lease("worker-a");
    if (task.job().id() != job.id()) {
      store_->fail(task.token(), v1::JobError(), false);
      continue;
    }
    if (task.kind() != v1::TASK_KIND_ERODE) {
      store_->complete(derive_header(task.token(), "skeleton", 3), "skeleton");
      break;
    }
    finish_block(task);
  }
  EXPECT_EQ(field(job.id()), expected_field(kPoints, kDirections));
  EXPECT_EQ(store_->events(job.id(), 0).givers_size(), 1);
}

// Others, which knew the lie as a bound, kept silent about what was greater: their directions count again, too.
TEST_F(VerifyTest, WhatALieKeptBackComesOut) {
  const v1::Job job = submit();
  prepare(kPoints, kDirections);
  const v1::Lease lie = lease("worker-b");
  v1::FieldRecords records = made_up_records(lie.job(), 0, 1);
  for (int i = 0; i < records.erosion_size(); ++i) records.set_erosion(i, 0.01);
  report(lie, {lie.positions().begin(), lie.positions().end()}, records, true);
  while (true) {
    const v1::Lease block = lease("worker-a");
    if (block.kind() != v1::TASK_KIND_ERODE) break;
    report(block, {block.positions().begin(), block.positions().end()}, v1::FieldRecords(), true);
  }
  store_->resume_without(job.id(), "worker-b");
  EXPECT_EQ(store_->job(job.id()).directions_done(), 0U);
  while (true) {
    const v1::Lease block = lease("worker-a");
    if (block.kind() != v1::TASK_KIND_ERODE) break;
    finish_block(block);
  }
  EXPECT_EQ(field(job.id()), expected_field(kPoints, kDirections));
}

TEST_F(VerifyTest, NoMachineHasSoMuchMemory) {
  submit();
  const v1::Lease task = lease();
  EXPECT_STORE_ERROR(store_->fail(task.token(), v1::JobError(), true, std::uint64_t{1} << 49), kInvalid);
  EXPECT_NO_THROW(store_->renew(task.token()));
}

// Whatever an owner has, to find out whether a submission is new costs the same.
TEST_F(VerifyTest, EqualSubmissionsAreFoundByContent) {
  submit();
  Database db(database(), Database::Mode::kReadOnly);
  Statement row = db.query(
      "EXPLAIN QUERY PLAN SELECT id FROM jobs WHERE owner = 'a' AND name = 'b' AND content = 'c' AND"
      " skeleton_key = 'd'");
  ASSERT_TRUE(row.step());
  EXPECT_NE(row.text(3).find("jobs_by_content"), std::string::npos) << row.text(3);
  EXPECT_EQ(count("SELECT count(*) FROM jobs WHERE content = ''"), 0);
}

}  // namespace
}  // namespace affskel::server
