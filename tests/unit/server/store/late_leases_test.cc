// Workers that fall silent and come back, and servers that were away: neither is a fault of the job.
#include "expect_store_error.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

class LateLeaseTest : public StoreTest {
 protected:
  /// The worker of a lease is silent for longer than it, and renews it then.
  void pause(const v1::Lease& lease) {
    clock_.advance(options_.lease_ms + 1);
    store_->expire_leases();
    store_->renew(lease.token());
  }
};

TEST_F(LateLeaseTest, ComingBackTakesTheLossBack) {
  const v1::Job job = submit();
  const v1::Lease late = lease();
  for (std::int64_t i = 0; i < 3 * options_.max_losses; ++i) pause(late);
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_RUNNING);
  EXPECT_EQ(store_->job(job.id()).counters().leases_lost(), 0U);
  const PrepareResult result = prepare_result(late.token(), 4, 16);
  EXPECT_FALSE(store_->complete(result.header, result.data).cancelled());
}

// Losses of others before it stay.
TEST_F(LateLeaseTest, NoMoreThanTheLossIsTakenBack) {
  const v1::Job job = submit();
  const auto lose_another = [&] {
    lease();
    store_->release_worker("test-host", 4711);
  };
  for (std::int64_t i = 2; i < options_.max_losses; ++i) lose_another();
  const v1::Lease late = lease();
  pause(late);
  store_->give_back(late.token());
  lose_another();
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_RUNNING);
  lose_another();
  EXPECT_EQ(store_->job(job.id()).error().code(), "WORKER_LOST");
}

TEST_F(LateLeaseTest, PatienceForProgressDoesNotBeginAnewWithEachPause) {
  const v1::Job job = submit();
  prepare(4, 16);
  const v1::Lease late = lease();
  for (std::int64_t awake = 0; awake < options_.stall_ms; awake += options_.lease_ms) {
    clock_.advance(options_.lease_ms);
    ASSERT_NO_THROW(store_->renew(late.token()));
    clock_.advance(60 * options_.stall_ms);  // much longer than the patience, which stands still meanwhile
    store_->expire_leases();
    ASSERT_NO_THROW(store_->renew(late.token()));
  }
  clock_.advance(options_.lease_ms);
  EXPECT_EQ(store_->expire_leases(), 1);
  EXPECT_STORE_ERROR(store_->renew(late.token()), kFenced);
  EXPECT_EQ(store_->job(job.id()).counters().leases_lost(), 1U);
}

// The longest pause between two reports tells how long a stall may be: what was none must not count.
TEST_F(LateLeaseTest, NeitherSilenceNorDowntimeIsAPauseBetweenReports) {
  const v1::Job job = submit();
  prepare(4, 16);
  const v1::Lease block = lease();
  clock_.advance(300);
  report(block, 0, 1);
  clock_.advance(3'600'000);
  store_->expire_leases();
  report(block, 1, 2);
  clock_.advance(200);
  report(block, 2, 3);
  clock_.advance(3'600'000);
  open();
  clock_.advance(100);
  report(block, 3, 4);
  EXPECT_EQ(store_->job(job.id()).counters().longest_report_gap_ms(), 300U);
}

TEST_F(LateLeaseTest, AClockThatWasPutBackHidesNoStall) {
  submit();
  prepare(4, 16);
  const v1::Lease block = lease();
  clock_.advance(-86'400'000);
  open();
  for (std::int64_t ms = 0; ms <= options_.stall_ms; ms += options_.lease_ms) {
    ASSERT_NO_THROW(store_->renew(block.token()));
    clock_.advance(options_.lease_ms);
  }
  EXPECT_EQ(store_->expire_leases(), 1);
  EXPECT_STORE_ERROR(store_->renew(block.token()), kFenced);
  finish_block(lease());
}

}  // namespace
}  // namespace affskel::server
