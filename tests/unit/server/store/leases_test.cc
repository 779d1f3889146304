#include <set>

#include "database/sqlite.h"
#include "expect_store_error.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

class LeaseTest : public StoreTest {
 protected:
  /// The positions of all blocks of a job of so many directions, in the order in which they are leased.
  std::vector<v1::PositionRange> all_blocks(std::uint32_t directions) {
    options_.max_leases_held = 1000;
    open();
    submit();
    prepare(4, directions);
    std::vector<v1::PositionRange> blocks;
    while (const std::optional<v1::Lease> block = store_->lease(worker_identity(), "", false)) {
      EXPECT_EQ(block->kind(), v1::TASK_KIND_ERODE);
      EXPECT_EQ(block->positions_size(), 1);
      blocks.push_back(block->positions(0));
    }
    return blocks;
  }
};

TEST_F(LeaseTest, NoWorkNoLease) {
  EXPECT_FALSE(store_->lease(worker_identity(), "", false));
  EXPECT_STORE_ERROR(store_->renew("no such token"), kFenced);
}

TEST_F(LeaseTest, RefusesIncompleteIdentities) {
  submit();
  v1::WorkerIdentity worker = worker_identity();
  worker.clear_id();
  EXPECT_STORE_ERROR(store_->lease(worker, "", false), kInvalid);
  worker = worker_identity();
  worker.clear_core_version();
  EXPECT_STORE_ERROR(store_->lease(worker, "", false), kInvalid);
}

TEST_F(LeaseTest, AJobThatCannotBeReadFailsAloneAndIsListed) {
  const std::string damaged = submit("OFF 1", "damaged").id(), other = submit("OFF 2", "other").id();
  store_.reset();
  {
    Database db(database(), Database::Mode::kReadWrite);
    db.execute(("UPDATE erosions SET params = x'ff' WHERE id = (SELECT erosion_id FROM jobs WHERE id = '" +
                damaged + "')")
                   .c_str());
  }
  open();
  EXPECT_EQ(lease().job().id(), other);
  const v1::Job told = store_->job(damaged);
  EXPECT_EQ(told.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(told.error().code(), "DAMAGED");
  EXPECT_EQ(store_->list({}).jobs.size(), 2U);
}

TEST_F(LeaseTest, CutsBlocksOfPositions) {
  std::set<std::uint64_t> begins;
  std::uint64_t covered = 0;
  for (const v1::PositionRange& block : all_blocks(1000)) {
    begins.insert(block.begin());
    covered += block.end() - block.begin();
  }
  EXPECT_EQ(begins.size(), 12U + 16U);  // 12 of 63 reach past 750, then 244 in blocks of 16
  EXPECT_EQ(covered, 1000U);
}

// The worker that ends last has little left to do alone.
TEST_F(LeaseTest, BlocksGetFinerTowardsTheEnd) {
  std::vector<std::uint64_t> sizes;
  std::uint64_t covered = 0;
  for (const v1::PositionRange& block : all_blocks(16000)) {
    EXPECT_EQ(block.begin(), covered);
    covered = block.end();
    sizes.push_back(covered - block.begin());
  }
  EXPECT_EQ(covered, 16000U);
  std::vector<std::uint64_t> expected(12, 1000);
  expected.insert(expected.end(), 12, 250);
  expected.insert(expected.end(), 15, 63);  // 15 * 63 of the last 1000 leave 55
  expected.push_back(55);
  EXPECT_EQ(sizes, expected);
}

TEST_F(LeaseTest, FewDirectionsMakeFewBlocks) {
  submit();
  prepare(4, 20);
  EXPECT_EQ(lease().positions(0).end(), 16U);
  EXPECT_EQ(lease().positions(0).begin(), 16U);
  EXPECT_FALSE(has_work());
}

TEST_F(LeaseTest, TwoWorkersNeverHoldTheSameTask) {
  submit();
  prepare(4, 40);
  const v1::Lease first = lease("worker-a");
  const v1::Lease second = lease("worker-b");
  EXPECT_NE(first.token(), second.token());
  EXPECT_NE(first.positions(0).begin(), second.positions(0).begin());
}

TEST_F(LeaseTest, PriorityThenPreferredJobThenAge) {
  const auto submit_with = [&](const std::string& mesh, std::uint32_t priority) {
    v1::SubmitJobHeader header = submit_header(mesh);
    header.set_priority(priority);
    return store_->submit(header, mesh).job.id();
  };
  const std::string old_low = submit_with("1", 3);
  const std::string old_high = submit_with("2", 9);
  const std::string new_low = submit_with("3", 3);
  const auto next = [&](const std::string& preferred) {
    return store_->lease(worker_identity(), preferred, false)->job().id();
  };
  EXPECT_EQ(next(new_low), old_high);
  EXPECT_EQ(next(new_low), new_low);
  EXPECT_EQ(next(new_low), old_low);
}

TEST_F(LeaseTest, CoreVersionsAreNeverMixed) {
  submit();
  prepare(4, 40);
  EXPECT_FALSE(store_->lease(worker_identity("worker-b", "2"), "", false));
  EXPECT_TRUE(store_->lease(worker_identity("worker-c", "1"), "", false));
}

TEST_F(LeaseTest, SaysWhenTheCoreVersionIsMissing) {
  const v1::Job job = submit();
  prepare(4, 16);
  EXPECT_EQ(store_->job(job.id()).waiting_reason(), "");
  EXPECT_FALSE(store_->lease(worker_identity("worker-b", "2"), "", false));
  EXPECT_NE(store_->job(job.id()).waiting_reason().find("core version 1"), std::string::npos);
  lease();
  EXPECT_EQ(store_->job(job.id()).waiting_reason(), "");
}

TEST_F(LeaseTest, RunningFromTheFirstLease) {
  const v1::Job job = submit();
  clock_.advance(10);
  lease();
  const v1::Job running = store_->job(job.id());
  EXPECT_EQ(running.state(), v1::JOB_STATE_RUNNING);
  EXPECT_EQ(running.started_ms(), job.created_ms() + 10);
  EXPECT_EQ(running.counters().leases_granted(), 1U);
}

TEST_F(LeaseTest, SilentWorkerLosesItsLease) {
  const v1::Job job = submit();
  const v1::Lease lost = lease();
  clock_.advance(options_.lease_ms);
  EXPECT_EQ(store_->expire_leases(), 0) << "the deadline itself is still in time";
  clock_.advance(1);
  EXPECT_EQ(store_->expire_leases(), 1);
  EXPECT_EQ(lease("worker-b").kind(), v1::TASK_KIND_PREPARE);
  EXPECT_STORE_ERROR(store_->renew(lost.token()), kFenced);
  EXPECT_EQ(store_->job(job.id()).counters().leases_lost(), 1U);
}

// A machine that stood still for a moment has computed all the same.
TEST_F(LeaseTest, LateWorkerGoesOnWhereNoOtherHasTakenItsTask) {
  const v1::Job job = submit();
  prepare(4, 16);
  const v1::Lease block = lease();
  for (std::uint64_t i = 0; i < 16; ++i) {
    clock_.advance(options_.lease_ms + 1);
    EXPECT_EQ(store_->expire_leases(), 1);
    if (i == 8) open();
    EXPECT_FALSE(report(block, i, i + 1, i == 15).cancelled());
    EXPECT_EQ(has_work("worker-b"), i == 15) << "it holds its block again";
  }
  const v1::Job eroded = store_->job(job.id());
  EXPECT_EQ(eroded.stage(), v1::JOB_STAGE_DERIVE);
  EXPECT_EQ(eroded.counters().leases_lost(), 0U) << "it came back";
  EXPECT_NEAR(eroded.counters().directions_lost_estimate(), 0, 1e-9);
  derive();
  EXPECT_EQ(field(job.id()), expected_field(4, 16));
}

TEST_F(LeaseTest, LateWorkerHandsInItsResultOrItsLease) {
  submit();
  const v1::Lease first = lease();
  clock_.advance(options_.lease_ms + 1);
  store_->expire_leases();
  store_->give_back(first.token());
  EXPECT_STORE_ERROR(store_->renew(first.token()), kFenced);
  const v1::Lease second = lease();
  clock_.advance(options_.lease_ms + 1);
  store_->expire_leases();
  const PrepareResult result = prepare_result(second.token(), 4, 16);
  EXPECT_FALSE(store_->complete(result.header, result.data).cancelled());
  EXPECT_EQ(lease("worker-b").kind(), v1::TASK_KIND_ERODE);
}

TEST_F(LeaseTest, LateWorkerOfACancelledJobIsTold) {
  const v1::Job job = submit();
  prepare(4, 16);
  const v1::Lease block = lease();
  clock_.advance(options_.lease_ms + 1);
  store_->expire_leases();
  EXPECT_EQ(store_->cancel(job.id()).state(), v1::JOB_STATE_CANCELLED);
  EXPECT_TRUE(report(block, 0, 5).cancelled());
  EXPECT_EQ(store_->job(job.id()).directions_done(), 5U);
  EXPECT_STORE_ERROR(store_->renew(block.token()), kFenced);
}

TEST_F(LeaseTest, LateWorkerIsNotGivenItsOwnTaskAsANewOne) {
  const v1::Job job = submit();
  prepare(4, 16);
  const v1::Lease late = lease();
  clock_.advance(options_.lease_ms + 1);
  EXPECT_FALSE(store_->lease(worker_identity(), "", false, {late.token(), "ended long ago"}));
  EXPECT_FALSE(report(late, 0, 16, true).cancelled());
  EXPECT_EQ(store_->job(job.id()).stage(), v1::JOB_STAGE_DERIVE);
  EXPECT_EQ(store_->job(job.id()).counters().leases_granted(), 2U) << "prepared, eroded";
}

TEST_F(LeaseTest, AskingForWorkRenewsWhatIsHeld) {
  submit();
  const v1::Lease held = lease();
  for (int i = 0; i < 3; ++i) {
    clock_.advance(options_.lease_ms);
    EXPECT_FALSE(store_->lease(worker_identity(), "", false, {held.token()}));
  }
  EXPECT_EQ(store_->expire_leases(), 0);
  EXPECT_STORE_ERROR(store_->lease(worker_identity(), "", false, std::vector<std::string>(17)), kInvalid);
}

TEST_F(LeaseTest, AskingForWorkDoesNotEndWhatWasCancelled) {
  const v1::Job job = submit();
  prepare(4, 16);
  const v1::Lease block = lease();
  store_->cancel(job.id());
  EXPECT_FALSE(store_->lease(worker_identity(), "", false, {block.token()}));
  EXPECT_TRUE(report(block, 0, 5).cancelled()) << "it has to be told";
  EXPECT_EQ(store_->job(job.id()).directions_done(), 5U);
}

TEST_F(LeaseTest, ExpiryIsNoticedWhenLeasing) {
  submit();
  lease();
  EXPECT_FALSE(has_work("worker-b"));
  clock_.advance(options_.lease_ms + 1);
  EXPECT_TRUE(has_work("worker-b"));
}

TEST_F(LeaseTest, RenewalKeepsTheLease) {
  submit();
  const v1::Lease kept = lease();
  for (int i = 0; i < 5; ++i) {
    clock_.advance(options_.lease_ms);
    const v1::ReportResponse response = store_->renew(kept.token());
    EXPECT_FALSE(response.cancelled());
    EXPECT_EQ(response.lease_ms(), options_.lease_ms);
    EXPECT_EQ(response.report_interval_ms(), options_.report_interval_ms);
    EXPECT_EQ(store_->expire_leases(), 0);
  }
}

TEST_F(LeaseTest, FencedReportChangesNothing) {
  const v1::Job job = submit();
  prepare(4, 16);
  const v1::Lease old = lease("worker-a");
  clock_.advance(options_.lease_ms + 1);
  const v1::Lease current = lease("worker-b");
  EXPECT_STORE_ERROR(report(old, 0, 5), kFenced);
  EXPECT_EQ(store_->job(job.id()).directions_done(), 0U);
  report(current, 0, 5);
  EXPECT_EQ(store_->job(job.id()).directions_done(), 5U);
}

TEST_F(LeaseTest, NextWorkerGetsWhatIsLeft) {
  submit();
  prepare(4, 16);
  const v1::Lease first = lease("worker-a");
  report(first, 2, 5);
  report(first, 9, 12);
  clock_.advance(options_.lease_ms + 1);
  const v1::Lease rest = lease("worker-b");
  ASSERT_EQ(rest.positions_size(), 3);
  EXPECT_EQ(rest.positions(0).begin(), 0U);
  EXPECT_EQ(rest.positions(0).end(), 2U);
  EXPECT_EQ(rest.positions(1).begin(), 5U);
  EXPECT_EQ(rest.positions(1).end(), 9U);
  EXPECT_EQ(rest.positions(2).begin(), 12U);
  EXPECT_EQ(rest.positions(2).end(), 16U);
}

TEST_F(LeaseTest, BlockThatWasFinishedButNotClosedIsNotLeasedAgain) {
  const v1::Job job = submit();
  prepare(4, 16);
  report(lease(), 0, 16, false);  // and then the worker dies
  clock_.advance(options_.lease_ms + 1);
  store_->expire_leases();
  EXPECT_EQ(store_->job(job.id()).stage(), v1::JOB_STAGE_DERIVE);
}

TEST_F(LeaseTest, ReturnedLeaseIsNotALoss) {
  const v1::Job job = submit();
  store_->give_back(lease().token());
  EXPECT_TRUE(has_work());
  EXPECT_EQ(store_->job(job.id()).counters().leases_lost(), 0U);
}

TEST_F(LeaseTest, TooManyLossesWithoutProgressFailTheJob) {
  const v1::Job job = submit();
  for (std::int64_t i = 0; i < options_.max_losses; ++i) {
    EXPECT_NE(store_->job(job.id()).state(), v1::JOB_STATE_FAILED);
    lease();
    clock_.advance(options_.lease_ms + 1);
    store_->expire_leases();
  }
  const v1::Job failed = store_->job(job.id());
  EXPECT_EQ(failed.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(failed.error().code(), "WORKER_LOST");
  EXPECT_NE(failed.error().message().find("prepare"), std::string::npos);
  EXPECT_FALSE(has_work());
}

TEST_F(LeaseTest, ProgressForgivesLosses) {
  const v1::Job job = submit();
  prepare(4, 16);
  for (std::uint64_t i = 0; i < 16; ++i) {
    const v1::Lease block = lease();
    report(block, i, i + 1);
    clock_.advance(options_.lease_ms + 1);
    store_->expire_leases();
  }
  EXPECT_EQ(store_->job(job.id()).stage(), v1::JOB_STAGE_DERIVE);
  EXPECT_EQ(store_->job(job.id()).counters().leases_lost(), 16U);
}

TEST_F(LeaseTest, DeadProcessLosesItsLeasesAtOnce) {
  submit("OFF 1");
  submit("OFF 2");
  lease();
  v1::WorkerIdentity other = worker_identity("worker-b");
  other.set_pid(4712);
  ASSERT_TRUE(store_->lease(other, "", false));
  EXPECT_EQ(store_->release_worker("another-host", 4711), 0);
  EXPECT_EQ(store_->release_worker("test-host", 4711), 1);
  EXPECT_TRUE(has_work());
}

TEST_F(LeaseTest, EstimatesWhatALossCost) {
  const v1::Job job = submit();
  prepare(4, 64);
  const v1::Lease block = lease();
  clock_.advance(1000);
  report(block, 0, 4);  // 4 directions a second
  clock_.advance(500);
  store_->release_worker("test-host", 4711);
  EXPECT_DOUBLE_EQ(store_->job(job.id()).counters().directions_lost_estimate(), 2.0);

  const v1::Lease next = lease();
  clock_.advance(1000);
  report(next, 4, 8);
  clock_.advance(options_.lease_ms + 1);  // it would have reported after one interval
  store_->expire_leases();
  EXPECT_DOUBLE_EQ(store_->job(job.id()).counters().directions_lost_estimate(), 6.0);

  lease();
  clock_.advance(options_.lease_ms + 1);  // never reported: the job's own rate since its start
  store_->expire_leases();
  const double elapsed =
      static_cast<double>(clock_.wall_ms()) - static_cast<double>(store_->job(job.id()).started_ms());
  EXPECT_DOUBLE_EQ(store_->job(job.id()).counters().directions_lost_estimate(),
                   6.0 + 8.0 / elapsed * static_cast<double>(options_.report_interval_ms));
}

TEST_F(LeaseTest, ALossCostsNoMoreThanWasLeased) {
  const v1::Job job = submit();
  prepare(4, 64);
  const v1::Lease block = lease();
  const std::uint64_t end = block.positions(0).end();
  clock_.advance(10);
  report(block, 0, end - 2);
  clock_.advance(options_.report_interval_ms);  // enough for the whole job
  store_->release_worker("test-host", 4711);
  EXPECT_DOUBLE_EQ(store_->job(job.id()).counters().directions_lost_estimate(), 2.0);
}

TEST_F(LeaseTest, LeasesSurviveARestart) {
  const v1::Job job = submit();
  prepare(4, 16);
  const v1::Lease block = lease();
  report(block, 0, 3);
  clock_.advance(10 * options_.lease_ms);  // the server was away for longer than the lease
  open();
  EXPECT_EQ(store_->expire_leases(), 0);
  EXPECT_FALSE(has_work("worker-b"));
  report(block, 3, 16, true);
  EXPECT_EQ(store_->job(job.id()).directions_done(), 16U);
  EXPECT_EQ(store_->job(job.id()).counters().leases_lost(), 0U);
}

TEST_F(LeaseTest, AfterARestartALeaseStillEnds) {
  submit();
  lease();
  open();
  clock_.advance(options_.lease_ms + 1);
  EXPECT_EQ(store_->expire_leases(), 1);
}

TEST_F(LeaseTest, RemembersSupervisedHolders) {
  submit("OFF 1");
  submit("OFF 2");
  lease();
  EXPECT_TRUE(store_->supervised_holders().empty());
  ASSERT_TRUE(store_->lease(worker_identity("worker-b"), "", true));
  open();
  const std::vector<Store::Holder> holders = store_->supervised_holders();
  ASSERT_EQ(holders.size(), 1U);
  EXPECT_EQ(holders[0].host, "test-host");
  EXPECT_EQ(holders[0].pid, 4711);
}

}  // namespace
}  // namespace affskel::server
