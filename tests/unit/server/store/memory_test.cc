// Tasks go to workers with enough memory.

#include "store/memory_need.h"

#include <set>

#include "store_fixture.h"

namespace affskel::server {
namespace {

constexpr std::uint64_t kGiga = 1'000'000'000;

TEST(MemoryNeedTest, RoundsUpByAnEighthAtMost) {
  EXPECT_EQ(rounded_need(0), 0);
  EXPECT_EQ(rounded_need((64 << 20) - 1), 0);
  EXPECT_EQ(rounded_need(64 << 20), 64 << 20);
  std::set<std::int64_t> values;
  for (std::uint64_t bytes = 64 << 20; bytes < std::uint64_t{1} << 40; bytes += bytes / 97) {
    const std::int64_t rounded = rounded_need(bytes);
    EXPECT_GE(static_cast<std::uint64_t>(rounded), bytes);
    EXPECT_LE(static_cast<double>(rounded), 1.125 * static_cast<double>(bytes));
    values.insert(rounded);
  }
  EXPECT_LE(values.size(), 14U * 8 + 1) << "few different ones: the queue looks at each";
  EXPECT_GT(rounded_need(~std::uint64_t{0}), 0);
}

TEST(MemoryNeedTest, IsThatOfTheMeasuredLimits) {
  v1::PreparedSummary prepared;
  prepared.set_triangles(1'000'000);
  prepared.set_points(10'000'000);
  const auto need = [&](v1::TaskKind kind, v1::Operator shocks = v1::OPERATOR_UNSPECIFIED) {
    return memory_need(kind, 50'000'000, {}, prepared, shocks);
  };
  EXPECT_EQ(need(v1::TASK_KIND_ERODE), 235'000'000U + 520'000'000U);
  EXPECT_EQ(need(v1::TASK_KIND_SURFACE, v1::OPERATOR_CHORDS), need(v1::TASK_KIND_ERODE) + 4 * kGiga);
  EXPECT_EQ(need(v1::TASK_KIND_PARTS, v1::OPERATOR_CURVE), need(v1::TASK_KIND_ERODE) + 2 * kGiga);
  v1::ErosionParams params;
  params.mutable_sampling()->set_target_points(10'000'000);
  EXPECT_GE(memory_need(v1::TASK_KIND_PREPARE, 50'000'000, params, {}, v1::OPERATOR_UNSPECIFIED),
            520'000'000U);
}

class MemoryTest : public StoreTest {
 protected:
  static v1::WorkerIdentity worker_with(std::uint64_t memory) {
    v1::WorkerIdentity worker = worker_identity("with-" + std::to_string(memory));
    worker.set_memory(memory);
    return worker;
  }

  std::optional<v1::Lease> lease_with(std::uint64_t memory) {
    return store_->lease(worker_with(memory), "", false);
  }

  /// A job whose blocks need about 5.4 GB.
  std::string large_job(const std::string& owner = "ada") {
    v1::SubmitJobHeader header = submit_header("OFF large");
    header.set_owner(owner);
    const std::string id = store_->submit(header, "OFF large").job.id();
    PrepareResult result = prepare_result(lease().token(), 10, 600);
    result.header.mutable_prepared()->set_triangles(23'000'000);
    store_->complete(result.header, result.data);
    return id;
  }
};

TEST_F(MemoryTest, LargeTasksWaitForLargeWorkersAndSmallOnesGoOn) {
  const std::string large = large_job();
  const std::string small = submit("OFF small").id();
  EXPECT_EQ(lease_with(4 * kGiga)->job().id(), small);
  EXPECT_FALSE(lease_with(4 * kGiga));
  EXPECT_EQ(lease_with(8 * kGiga)->job().id(), large);
  EXPECT_EQ(lease_with(0)->job().id(), large) << "a worker that does not say is offered everything";
}

// The turn of an owner that only other workers can serve is not lost, and not waited for.
TEST_F(MemoryTest, TurnsAreAmongWhatTheWorkerCanDo) {
  const std::string large = large_job("ada");
  v1::SubmitJobHeader header = submit_header("OFF bob");
  header.set_owner("bob");
  store_->submit(header, "OFF bob");
  EXPECT_EQ(lease_with(kGiga)->job().owner(), "bob");
  EXPECT_FALSE(lease_with(kGiga));
  EXPECT_EQ(lease_with(8 * kGiga)->job().id(), large);
}

TEST_F(MemoryTest, TheJobTellsWhatItNeeds) {
  const std::string large = large_job();
  const std::uint64_t need = store_->job(large).memory_needed();
  EXPECT_GE(need, 5'405'000'000U);
  EXPECT_LE(need, 6'080'000'000U);
  EXPECT_EQ(submit("OFF small").memory_needed(), 0U);
}

TEST_F(MemoryTest, AWorkerThatFindsATaskTooLargeLeavesItToALargerOne) {
  const std::string id = submit("OFF 1").id();
  v1::JobError error;
  error.set_code("LIMIT");
  error.set_message("the lattice takes 3 GB");
  store_->fail(lease_with(2 * kGiga)->token(), error, false, 3 * kGiga);
  EXPECT_NE(store_->job(id).state(), v1::JOB_STATE_FAILED);
  EXPECT_GE(store_->job(id).memory_needed(), 3 * kGiga);
  EXPECT_FALSE(lease_with(2 * kGiga));
  // A worker that had as much, and less of it free: it must not be asked again and again.
  const std::uint64_t enough = store_->job(id).memory_needed();
  store_->fail(lease_with(enough)->token(), error, false, 3 * kGiga);
  EXPECT_FALSE(lease_with(enough));
  EXPECT_TRUE(lease_with(enough * 2));
}

TEST_F(MemoryTest, ResumeForgetsWhatWorkersFound) {
  const std::string id = submit("OFF 1").id();
  v1::JobError error;
  error.set_code("LIMIT");
  store_->fail(lease_with(2 * kGiga)->token(), error, false, 3 * kGiga);
  store_->cancel(id);
  store_->resume(id);
  EXPECT_EQ(store_->job(id).memory_needed(), 0U);
  EXPECT_TRUE(lease_with(2 * kGiga));
}

TEST_F(MemoryTest, WhatIsNoMatterOfMemoryFailsAsEver) {
  const std::string id = submit("OFF 1").id();
  v1::JobError error;
  error.set_code("LIMIT");
  error.set_message("more than 2^31 points");
  store_->fail(lease_with(2 * kGiga)->token(), error, false);
  EXPECT_EQ(store_->job(id).state(), v1::JOB_STATE_FAILED);
}

}  // namespace
}  // namespace affskel::server
