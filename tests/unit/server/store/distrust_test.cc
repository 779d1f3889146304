// What becomes of other jobs when an administrator distrusts a worker.
#include "store/distrust.h"

#include "expect_store_error.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

constexpr std::uint32_t kDistrustPoints = 10, kDistrustDirections = 32;

class DistrustTest : public StoreTest {
 protected:
  /// A job of which the liar gave the first block and is silent about the second.
  v1::Job job_with_lie() {
    const v1::Job job = submit("OFF lie", "lie");
    prepare(kDistrustPoints, kDistrustDirections);
    finish_block(lease("liar"));
    return job;
  }
};

TEST_F(DistrustTest, EndsLateLeasesOnOtherJobs) {
  const v1::Job job = job_with_lie();
  const v1::Lease ending = lease("liar");
  submit("OFF 2", "another");
  const v1::Lease late = lease("liar");
  ASSERT_EQ(late.job().name(), "another");
  clock_.advance(options_.lease_ms + 1);
  ASSERT_EQ(store_->expire_leases(), 2);
  store_->resume_without(job.id(), "liar");
  EXPECT_STORE_ERROR(store_->renew(late.token()), kFenced);
  EXPECT_STORE_ERROR(store_->renew(ending.token()), kFenced);
  const PrepareResult result = prepare_result(late.token(), kDistrustPoints, kDistrustDirections);
  EXPECT_STORE_ERROR(store_->complete(result.header, result.data), kFenced);
}

TEST_F(DistrustTest, EndsWhatMayBeRepeatedOfOtherJobs) {
  const v1::Job job = job_with_lie();
  store_->cancel(job.id());
  submit("OFF 2", "another");
  prepare(kDistrustPoints, kDistrustDirections);
  const v1::Lease block = lease("liar");
  finish_block(block);
  EXPECT_NO_THROW(store_->renew(block.token())) << "its last report may be repeated";
  store_->resume_without(job.id(), "liar");
  EXPECT_STORE_ERROR(store_->renew(block.token()), kFenced);
}

TEST_F(DistrustTest, EndsJobsOfTheFieldThatAreToBeCancelled) {
  const v1::Job job = job_with_lie();
  finish_block(lease());
  derive();
  v1::SubmitJobHeader header = submit_header("OFF lie", "of the same field");
  header.mutable_skeleton()->set_threshold(3);
  const std::string other = store_->submit(header, "OFF lie").job.id();
  ASSERT_EQ(lease("deriving").job().id(), other);
  ASSERT_EQ(store_->cancel(other).state(), v1::JOB_STATE_RUNNING);
  EXPECT_EQ(store_->resume_without(job.id(), "liar").stage(), v1::JOB_STAGE_ERODE) << "it keeps what is left";
  EXPECT_EQ(store_->job(other).state(), v1::JOB_STATE_CANCELLED);
}

// What a liar gave has to go whatever else its owner has queued.
TEST_F(DistrustTest, NoQuotaStandsAgainstIt) {
  const v1::Job job = job_with_lie();
  ASSERT_EQ(store_->cancel(job.id()).state(), v1::JOB_STATE_CANCELLED);
  submit("OFF 2", "queued");
  options_.policy.everyone.quota.queued_jobs = 1;
  open();
  EXPECT_STORE_ERROR(store_->resume(job.id()), kLimit);
  EXPECT_EQ(store_->resume_without(job.id(), "liar").state(), v1::JOB_STATE_QUEUED);
}

// By its host: under another id it would come back from the same machine.
TEST_F(DistrustTest, AHostGetsNoWorkUntilItIsTrustedAgain) {
  const v1::Job job = job_with_lie();
  v1::WorkerIdentity honest = worker_identity("honest");
  honest.set_host("another-host");
  const v1::Lease held = lease("of the same host");
  store_->resume_without(job.id(), "test-host");
  EXPECT_STORE_ERROR(store_->renew(held.token()), kFenced);
  EXPECT_STORE_ERROR(lease("new"), kForbidden);
  EXPECT_TRUE(store_->distrusted().contains("test-host"));
  EXPECT_TRUE(store_->lease(honest, "", false));
  open();
  EXPECT_STORE_ERROR(lease("new"), kForbidden);
  Database db(database(), Database::Mode::kReadWrite);
  EXPECT_EQ(error_of([&] { trust(db, "elsewhere"); }),
            "nobody distrusts the host 'elsewhere'; distrusted, or with such workers: 'test-host'");
  trust(db, "test-host");
  EXPECT_NO_THROW(store_->give_back(lease("new").token()));
  EXPECT_NO_THROW(lease("liar"));
  EXPECT_STORE_ERROR(trust(db, "test-host"), kNotFound);
}

TEST_F(DistrustTest, AWorkerAloneLeavesOthersOfItsHost) {
  const v1::Job job = job_with_lie();
  store_->resume_without(job.id(), "liar");
  EXPECT_STORE_ERROR(lease("liar"), kForbidden);
  EXPECT_NO_THROW(store_->give_back(lease("new").token()));
  Database db(database(), Database::Mode::kReadWrite);
  EXPECT_STORE_ERROR(trust(db, "liar"), kNotFound);
  trust(db, "test-host");
  EXPECT_NO_THROW(lease("liar"));
}

}  // namespace
}  // namespace affskel::server
