#include <limits>

#include "expect_store_error.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

using LifecycleTest = StoreTest;

TEST_F(LifecycleTest, GoesThroughAllStages) {
  const v1::Job submitted = submit();
  prepare(10, 20);
  const v1::Job prepared = store_->job(submitted.id());
  EXPECT_EQ(prepared.stage(), v1::JOB_STAGE_ERODE);
  EXPECT_EQ(prepared.directions_total(), 20U);
  EXPECT_EQ(prepared.prepared().points(), 10U);
  EXPECT_GT(prepared.order_stride(), 0U);
  finish_block(lease());
  finish_block(lease());
  EXPECT_EQ(store_->job(submitted.id()).stage(), v1::JOB_STAGE_DERIVE);
  clock_.advance(5);
  derive("skeleton", 3);
  const v1::Job done = store_->job(submitted.id());
  EXPECT_EQ(done.state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(done.stage(), v1::JOB_STAGE_COMPLETE);
  EXPECT_EQ(done.skeleton_points(), 3U);
  EXPECT_EQ(done.finished_ms(), submitted.created_ms() + 5);
  EXPECT_FALSE(has_work());
}

TEST_F(LifecycleTest, AJobTellsTheCoreThatComputesIt) {
  const std::string id = submit().id();
  EXPECT_EQ(store_->job(id).core_version(), "");
  prepare(10, 20);
  EXPECT_EQ(store_->job(id).core_version(), worker_identity().core_version());
  EXPECT_EQ(store_->list({}).jobs.at(0).core_version(), worker_identity().core_version());
}

TEST_F(LifecycleTest, SolidWithoutSamplePointsIsComplete) {
  const v1::Job job = submit();
  erode(0, 3);
  derive("", 0);
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(field(job.id()), "");
}

TEST_F(LifecycleTest, RefusesWrongPrepareResults) {
  submit();
  const v1::Lease task = lease();
  const auto refused = [&](auto change) {
    PrepareResult result = prepare_result(task.token(), 10, 20);
    change(result);
    EXPECT_STORE_ERROR(store_->complete(result.header, result.data), kInvalid);
  };
  refused([](auto& r) { r.data.pop_back(); });
  refused([](auto& r) { r.data[0] ^= 1; });
  refused([](auto& r) { r.header.clear_prepared(); });
  refused([](auto& r) { r.header.set_order_stride(5); });  // not coprime to 20
  refused([](auto& r) { r.header.set_order_stride(0); });
  refused([](auto& r) { r.header.mutable_prepared()->set_points(11); });
  refused([](auto& r) { r.header.mutable_prepared()->set_directions(21); });
  refused([](auto& r) { r.header.mutable_prepared()->set_directions(0); });
  refused([](auto& r) { r.header.mutable_prepared()->set_volume(0); });
  refused([](auto& r) { r.header.mutable_prepared()->clear_bbox_min(); });
  refused(
      [](auto& r) { r.header.mutable_prepared()->set_bbox_max(1, std::numeric_limits<double>::infinity()); });
  refused([](auto& r) { r.header.set_lattice_bytes(r.header.lattice_bytes() + 1); });
  const PrepareResult good = prepare_result(task.token(), 10, 20);
  EXPECT_NO_THROW(store_->complete(good.header, good.data));
  EXPECT_NO_THROW(store_->complete(good.header, good.data)) << "repeated because the answer was lost";
}

TEST_F(LifecycleTest, QueuedJobIsCancelledAtOnce) {
  const v1::Job job = submit();
  EXPECT_EQ(store_->cancel(job.id()).state(), v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(store_->cancel(job.id()).state(), v1::JOB_STATE_CANCELLED);
  EXPECT_FALSE(has_work());
}

TEST_F(LifecycleTest, RunningJobIsCancelledWhenItsWorkersKnow) {
  const v1::Job job = submit();
  prepare(10, 40);
  const v1::Lease first = lease("worker-a");
  const v1::Lease second = lease("worker-b");
  const v1::Job marked = store_->cancel(job.id());
  EXPECT_EQ(marked.state(), v1::JOB_STATE_RUNNING);
  EXPECT_TRUE(marked.cancel_requested());
  EXPECT_FALSE(has_work());
  EXPECT_TRUE(report(first, 0, 4).cancelled());
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_RUNNING);
  EXPECT_TRUE(store_->renew(second.token()).cancelled());
  const v1::Job cancelled = store_->job(job.id());
  EXPECT_EQ(cancelled.state(), v1::JOB_STATE_CANCELLED);
  EXPECT_FALSE(cancelled.cancel_requested());
  EXPECT_EQ(cancelled.directions_done(), 4U) << "the last report is kept";
}

TEST_F(LifecycleTest, CancelDoesNotWaitForADeadWorker) {
  const v1::Job job = submit();
  lease();
  store_->cancel(job.id());
  clock_.advance(options_.lease_ms + 1);
  store_->expire_leases();
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_CANCELLED);
}

TEST_F(LifecycleTest, ResumeGoesOnFromTheProgress) {
  const v1::Job job = submit();
  prepare(100, 16);
  report(lease(), 0, 10);
  store_->cancel(job.id());
  clock_.advance(options_.lease_ms + 1);
  store_->expire_leases();
  const v1::Job resumed = store_->resume(job.id());
  EXPECT_EQ(resumed.state(), v1::JOB_STATE_QUEUED);
  EXPECT_EQ(resumed.finished_ms(), 0U);
  EXPECT_EQ(resumed.directions_done(), 10U);
  const v1::Lease rest = lease();
  EXPECT_EQ(rest.positions(0).begin(), 10U);
  finish_block(rest);
  EXPECT_EQ(field(job.id()), expected_field(100, 16));
}

TEST_F(LifecycleTest, ResumeTakesBackACancelMark) {
  const v1::Job job = submit();
  const v1::Lease task = lease();
  store_->cancel(job.id());
  EXPECT_EQ(store_->resume(job.id()).state(), v1::JOB_STATE_RUNNING);
  EXPECT_FALSE(store_->renew(task.token()).cancelled());
}

TEST_F(LifecycleTest, DoneJobsAreNeitherCancelledNorResumed) {
  const v1::Job job = complete_job(10, 20);
  EXPECT_STORE_ERROR(store_->cancel(job.id()), kPrecondition);
  EXPECT_STORE_ERROR(store_->resume(job.id()), kPrecondition);
}

TEST_F(LifecycleTest, DeterministicFailureFailsTheJobAtOnce) {
  const v1::Job job = submit();
  v1::JobError error;
  error.set_code("BAD_INPUT");
  error.set_message("line 3: not a number");
  error.set_line(3);
  store_->fail(lease().token(), error, false);
  const v1::Job failed = store_->job(job.id());
  EXPECT_EQ(failed.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(failed.error().code(), "BAD_INPUT");
  EXPECT_EQ(failed.error().message(), "line 3: not a number");
  EXPECT_EQ(failed.error().line(), 3U);
  EXPECT_FALSE(has_work());
  EXPECT_EQ(store_->resume(job.id()).state(), v1::JOB_STATE_QUEUED);
  EXPECT_FALSE(store_->job(job.id()).has_error());
  EXPECT_TRUE(has_work());
}

TEST_F(LifecycleTest, ReasonsHaveABound) {
  const v1::Job job = submit();
  v1::JobError error;
  error.set_code("BAD_INPUT");
  error.set_message(std::string(3999, 'x') + "\xC3\xB6" + std::string(1 << 20, 'y'));
  store_->fail(lease().token(), error, false);
  EXPECT_EQ(store_->job(job.id()).error().message(), std::string(3999, 'x') + "...");
}

TEST_F(LifecycleTest, RetryableFailuresAreRetriedAndBounded) {
  const v1::Job job = submit();
  v1::JobError error;
  error.set_code("LIMIT");
  error.set_message("out of memory");
  for (std::int64_t i = 0; i < options_.max_losses; ++i) store_->fail(lease().token(), error, true);
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(store_->job(job.id()).error().message(), "out of memory");
  EXPECT_EQ(store_->job(job.id()).counters().leases_lost(), 0U);
}

TEST_F(LifecycleTest, WorkersOfAFailedJobAreToldToStop) {
  const v1::Job job = submit();
  prepare(10, 40);
  const v1::Lease good = lease("worker-a");
  const v1::Lease bad = lease("worker-b");
  v1::JobError error;
  error.set_code("INTERNAL");
  error.set_message("an invariant broke");
  store_->fail(bad.token(), error, false);
  EXPECT_TRUE(report(good, 0, 5).cancelled());
  EXPECT_EQ(store_->job(job.id()).directions_done(), 5U);
  EXPECT_STORE_ERROR(report(good, 5, 6), kFenced);
}

TEST_F(LifecycleTest, OnlyInactiveJobsAreDeleted) {
  const v1::Job job = submit();
  EXPECT_STORE_ERROR(store_->remove(job.id()), kPrecondition);
  store_->cancel(job.id());
  EXPECT_EQ(store_->remove(job.id().substr(0, 8)), job.id());
  EXPECT_STORE_ERROR(store_->job(job.id()), kNotFound);
}

TEST_F(LifecycleTest, DeletingKeepsWhatOthersNeed) {
  const v1::Job first = complete_job(10, 20, "first");
  const v1::Job second = submit("OFF 1", "second");
  store_->remove(first.id());
  EXPECT_EQ(field(second.id()), expected_field(10, 20));
  store_->remove(second.id());
  while (store_->tidy()) {
  }
  Database db(database(), Database::Mode::kReadOnly);
  for (const char* table : {"meshes", "mesh_chunks", "erosions", "field_chunks", "field_log", "done_ranges",
                            "artifacts", "artifact_chunks", "jobs", "tasks", "requests", "dropped_meshes"}) {
    EXPECT_EQ(db.integer(("SELECT count(*) FROM " + std::string(table)).c_str()), 0) << table;
  }
}

TEST_F(LifecycleTest, MeshIsSharedBetweenJobs) {
  v1::SubmitJobHeader coarse = submit_header("OFF 1");
  coarse.mutable_params()->mutable_sampling()->set_target_points(100);
  const v1::Job first = submit("OFF 1");
  store_->submit(coarse, "OFF 1");
  {
    Database db(database(), Database::Mode::kReadOnly);
    EXPECT_EQ(db.integer("SELECT count(*) FROM meshes"), 1);
  }
  store_->cancel(first.id());
  store_->remove(first.id());
  Database db(database(), Database::Mode::kReadOnly);
  EXPECT_EQ(db.integer("SELECT count(*) FROM meshes"), 1) << "the other job still needs it";
}

}  // namespace
}  // namespace affskel::server
