// What owners may use: what is counted, and what is refused.

#include "store/quota.h"

#include "expect_store_error.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

class QuotaTest : public StoreTest {
 protected:
  v1::Job submit_as(const std::string& owner, const std::string& mesh, const std::string& name = "body") {
    v1::SubmitJobHeader header = submit_header(mesh, name);
    header.set_owner(owner);
    return store_->submit(header, mesh).job;
  }

  /// Text of the refusal; fails when there is none.
  template <typename Body>
  std::string refused(Body&& body) {
    try {
      body();
    } catch (const StoreError& error) {
      EXPECT_EQ(error.code(), StoreError::Code::kLimit);
      return error.what();
    }
    ADD_FAILURE() << "was not refused";
    return {};
  }

  Use use(const std::string& owner) {
    Database db(database(), Database::Mode::kReadOnly);
    return use_of(db, owner);
  }

  std::int64_t erosion_bytes(const std::string& job) {
    Database db(database(), Database::Mode::kReadOnly);
    return db
        .integer(
            "SELECT 20 * ifnull(e.points, 0) + (SELECT ifnull(sum(bytes), 0) FROM artifacts WHERE erosion_id "
            "= e.id)"
            " FROM jobs j JOIN erosions e ON e.id = j.erosion_id WHERE j.id = ?",
            job)
        .value();
  }

  void limit(const std::function<void(Policy&)>& change) {
    change(options_.policy);
    open();
  }
};

TEST_F(QuotaTest, UseIsCountedOnceHoweverManyJobsShareIt) {
  const v1::Job first = complete_job(10, 20, "first");
  const std::int64_t results = erosion_bytes(first.id());
  EXPECT_GT(results, 200);
  EXPECT_EQ(use("ada").mesh_bytes, 5);
  EXPECT_EQ(use("ada").stored_bytes, 5 + results);
  const v1::Job second = submit_as("ada", "OFF 1", "second");
  EXPECT_EQ(use("ada").stored_bytes, 5 + results) << "the same field, shared";
  submit_as("bob", "OFF 1", "third");
  EXPECT_EQ(use("bob").stored_bytes, 5) << "the mesh counts for another owner, too; his field is yet to come";
  const v1::Job waiting = submit_as("ada", "OFF 22", "other");
  EXPECT_EQ(use("ada").queued_jobs, 1);
  EXPECT_EQ(use("ada").mesh_bytes, 11);
  store_->remove(first.id());
  EXPECT_EQ(use("ada").stored_bytes, 11 + results) << "the second job still has it";
  store_->remove(second.id());
  EXPECT_EQ(use("ada").stored_bytes, 6);
  store_->cancel(waiting.id());
  EXPECT_EQ(use("ada").queued_jobs, 0);
  store_->remove(waiting.id());
  EXPECT_EQ(use("ada").stored_bytes, 0);
  EXPECT_EQ(use("bob").stored_bytes, 5);
}

TEST_F(QuotaTest, QueuedJobsOfAnOwner) {
  limit([](Policy& policy) {
    policy.everyone.quota.queued_jobs = 2;
    policy.owners["bob"].quota.queued_jobs = 3;
  });
  const v1::Job first = submit_as("ada", "OFF 1");
  submit_as("ada", "OFF 2");
  const std::string why = refused([&] { submit_as("ada", "OFF 3"); });
  EXPECT_NE(why.find("owner 'ada' has 2 of 2 jobs queued or running (queued-jobs)"), std::string::npos)
      << why;
  EXPECT_NO_THROW(submit_as("ada", "OFF 2")) << "the same again is no new job";
  for (const char* mesh : {"OFF 1", "OFF 2", "OFF 3"}) submit_as("bob", mesh);
  refused([&] { submit_as("bob", "OFF 4"); });
  store_->cancel(first.id());
  submit_as("ada", "OFF 3");
  refused([&] { store_->resume(first.id()); });
  EXPECT_EQ(store_->job(first.id()).state(), v1::JOB_STATE_CANCELLED);
}

TEST_F(QuotaTest, QueuedJobsOfTheServer) {
  limit([](Policy& policy) { policy.server.queued_jobs = 2; });
  submit_as("ada", "OFF 1");
  submit_as("bob", "OFF 1");
  const std::string why = refused([&] { submit_as("cy", "OFF 1"); });
  EXPECT_NE(why.find("this server has 2 of 2 jobs"), std::string::npos) << why;
}

TEST_F(QuotaTest, MeshBytes) {
  limit([](Policy& policy) { policy.everyone.quota.mesh_bytes = 12; });
  submit_as("ada", "OFF 1");
  submit_as("ada", "OFF 22");
  const std::string why = refused([&] { submit_as("ada", "OFF 3"); });
  EXPECT_NE(why.find("has 11 of 12 bytes of meshes (mesh-bytes), and this takes 5 more"), std::string::npos)
      << why;
  EXPECT_NO_THROW(submit_as("ada", "OFF 1", "again")) << "stored already";
  EXPECT_NO_THROW(submit_as("bob", "OFF 3"));
}

// Before the mesh is sent.
TEST_F(QuotaTest, TheHeaderAloneIsRefused) {
  limit([](Policy& policy) { policy.everyone.quota.mesh_bytes = 4; });
  const std::string why = refused([&] { store_->check(submit_header("OFF 1")); });
  EXPECT_NE(why.find("mesh-bytes"), std::string::npos) << why;
}

TEST_F(QuotaTest, StoredBytesAreLookedAtWhenTheFieldIsKnown) {
  limit([](Policy& policy) { policy.everyone.quota.stored_bytes = 3000; });
  const v1::Job job = submit();
  const PrepareResult result = prepare_result(lease().token(), 200, 20);
  EXPECT_TRUE(store_->complete(result.header, result.data).cancelled());
  const v1::Job failed = store_->job(job.id());
  EXPECT_EQ(failed.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(failed.error().code(), "LIMIT");
  const std::string more = std::to_string(200 * 20 + result.data.size());
  EXPECT_NE(
      failed.error().message().find("has 5 of 3000 bytes stored (stored-bytes), and this takes " + more),
      std::string::npos)
      << failed.error().message();
  EXPECT_EQ(use("ada").stored_bytes, 5) << "nothing of it was kept";
}

// What is made while the quota fills up does not go over it, and goes on when there is room.
TEST_F(QuotaTest, WhatAWorkerBringsCountsBeforeItIsStored) {
  const v1::Job job = submit();
  erode(10, 20);
  const std::int64_t used = use("ada").stored_bytes;
  options_.policy.everyone.quota.stored_bytes = used + 100;
  open();
  const std::string large(101, 'x');
  const v1::Lease task = lease();
  EXPECT_TRUE(store_->complete(derive_header(task.token(), large, 3), large).cancelled());
  EXPECT_EQ(store_->job(job.id()).error().code(), "LIMIT");
  EXPECT_EQ(use("ada").stored_bytes, used);
  store_->resume(job.id());
  derive();
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_DONE);
}

TEST_F(QuotaTest, RequestIdsOfAJob) {
  v1::SubmitJobHeader header = submit_header("OFF 1");
  header.set_owner("ada");
  for (int i = 0; i < 1000; ++i) {
    header.set_request_id("r" + std::to_string(i));
    store_->submit(header, "OFF 1");
  }
  EXPECT_NO_THROW(store_->submit(header, "OFF 1")) << "known";
  header.set_request_id("one more");
  const std::string why = refused([&] { store_->submit(header, "OFF 1"); });
  EXPECT_NE(why.find("1000 request ids"), std::string::npos) << why;
  header.clear_request_id();
  EXPECT_TRUE(store_->submit(header, "OFF 1").existed);
}

TEST_F(QuotaTest, WhoeverIsAboveStoredBytesAsksForNothingMore) {
  const v1::Job done = complete_job(10, 20);
  limit([](Policy& policy) { policy.everyone.quota.stored_bytes = 100; });
  v1::FetchArtifactRequest request;
  request.set_job(done.id());
  request.set_kind(v1::ARTIFACT_KIND_SKELETON);
  EXPECT_NE(store_->open_artifact(request).reader, nullptr) << "what is stored is given";
  request.mutable_skeleton()->set_threshold(3);
  refused([&] { store_->open_artifact(request); });
  refused([&] { submit_as("ada", "OFF 1", "other name"); });
}

TEST_F(QuotaTest, ChordsThatTheParametersTell) {
  limit([](Policy& policy) { policy.everyone.quota.chords = 1'000'000; });
  v1::SubmitJobHeader header = submit_header("OFF 1");
  header.mutable_params()->mutable_sampling()->set_target_points(2000);
  header.mutable_params()->set_directions("sphere:1000");
  const std::string why = refused([&] { store_->check(header); });
  EXPECT_NE(why.find("2000 points x 1000 directions = 2000000 chords"), std::string::npos) << why;
  EXPECT_NE(why.find("may have 1000000 (chords)"), std::string::npos) << why;
  header.mutable_params()->mutable_sampling()->set_target_points(1000);
  EXPECT_NO_THROW(store_->check(header));
}

TEST_F(QuotaTest, ChordsThatOnlyTheMeshTells) {
  limit([](Policy& policy) { policy.server.chords = 1000; });
  const v1::Job small = submit("OFF 1"), large = submit("OFF 2");
  prepare(50, 20);
  const v1::Lease task = store_->lease(worker_identity("other"), large.id(), false).value();
  EXPECT_EQ(store_->job(small.id()).state(), v1::JOB_STATE_RUNNING) << "at the limit";
  store_->give_back(task.token());
  store_->cancel(small.id());
  const PrepareResult result = prepare_result(lease().token(), 51, 20);
  store_->complete(result.header, result.data);
  const v1::Job failed = store_->job(large.id());
  EXPECT_EQ(failed.error().code(), "LIMIT");
  EXPECT_NE(failed.error().message().find("51 points x 20 directions = 1020 chords"), std::string::npos)
      << failed.error().message();
}

}  // namespace
}  // namespace affskel::server
