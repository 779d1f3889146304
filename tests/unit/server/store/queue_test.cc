// Whose turn it is: order, shares, bounds, and what is taken back.

#include <algorithm>
#include <random>
#include <tuple>

#include "expect_store_error.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

class QueueTest : public StoreTest {
 protected:
  std::string submit_with(const std::string& mesh, std::uint32_t priority) {
    v1::SubmitJobHeader header = submit_header(mesh, mesh);
    header.set_priority(priority);
    return store_->submit(header, mesh).job.id();
  }

  std::int64_t ask(const std::string& job, double threshold) {
    v1::FetchArtifactRequest request = artifact_request(job, v1::ARTIFACT_KIND_SKELETON);
    request.mutable_skeleton()->set_threshold(threshold);
    return store_->open_artifact(request).task;
  }

  std::int64_t requests() { return store_->counts().requests; }
};

// Against the rule itself, whatever was cancelled, resumed or made more urgent meanwhile.
TEST_F(QueueTest, TheIndexHasTheOrderOfWork) {
  struct Job {
    std::string id;
    std::uint32_t priority;
    int age;
    bool waits;
  };
  std::mt19937 random(7);
  std::vector<Job> jobs;
  for (int i = 0; i < 60; ++i) {
    const auto priority = static_cast<std::uint32_t>(random() % 10);
    jobs.push_back({submit_with("OFF " + std::to_string(i), priority), priority, i, true});
  }
  for (int i = 0; i < 60; ++i) {
    Job& job = jobs[random() % jobs.size()];
    switch (random() % 3) {
      case 0:
        store_->cancel(job.id);
        job.waits = false;
        break;
      case 1:
        store_->resume(job.id);
        job.waits = true;
        break;
      default: {
        if (!job.waits) break;
        const auto priority = static_cast<std::uint32_t>(random() % 10);
        submit_with("OFF " + std::to_string(job.age), priority);
        job.priority = std::max(job.priority, priority);
      }
    }
  }
  std::erase_if(jobs, [](const Job& job) { return !job.waits; });
  std::sort(jobs.begin(), jobs.end(), [](const Job& a, const Job& b) {
    return std::tie(b.priority, a.age) < std::tie(a.priority, b.age);
  });
  for (const Job& job : jobs) EXPECT_EQ(lease("worker-" + job.id).job().id(), job.id);
  EXPECT_FALSE(has_work());
}

// One worker, jobs and requests waiting: it takes them in turn.
TEST_F(QueueTest, RequestsHaveEverySecondGrantWhileJobsWait) {
  const v1::Job done = complete_job(10, 20);
  for (int i = 0; i < 4; ++i) submit_with("OFF other " + std::to_string(i), 9);
  for (int i = 0; i < 4; ++i) ask(done.id(), 3 + i);
  std::string turns;
  for (int i = 0; i < 8; ++i) {
    const v1::Lease task = lease();
    const bool request = task.kind() == v1::TASK_KIND_SKELETON;
    turns += request ? 'r' : 'j';
    if (request) {
      store_->complete(derive_header(task.token(), "x", 1), "x");
    } else {
      store_->fail(task.token(), v1::JobError(), false);
    }
  }
  EXPECT_EQ(turns, "rjrjrjrj");
}

TEST_F(QueueTest, RequestsHoldHalfOfTheWorkersWhileJobsWait) {
  const v1::Job done = complete_job(10, 20);
  for (int i = 0; i < 8; ++i) submit_with("OFF other " + std::to_string(i), 9);
  for (int i = 0; i < 8; ++i) ask(done.id(), 3 + i);
  int held = 0;
  for (int i = 0; i < 8; ++i) held += lease("w" + std::to_string(i)).kind() == v1::TASK_KIND_SKELETON;
  EXPECT_EQ(held, 4);
}

TEST_F(QueueTest, RequestsTakeAllWorkersWhenNoJobWaits) {
  const v1::Job done = complete_job(10, 20);
  for (int i = 0; i < 4; ++i) ask(done.id(), 3 + i);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(lease("w" + std::to_string(i)).kind(), v1::TASK_KIND_SKELETON);
}

TEST_F(QueueTest, ARequestIsTakenBackAlsoFromItsWorker) {
  const v1::Job done = complete_job(10, 20);
  const std::int64_t waiting = ask(done.id(), 3), leased = ask(done.id(), 4);
  v1::Lease first = lease();
  store_->withdraw(waiting);
  store_->withdraw(leased);
  EXPECT_EQ(requests(), 0);
  EXPECT_STORE_ERROR(store_->renew(first.token()), kFenced);
  EXPECT_FALSE(has_work());
}

TEST_F(QueueTest, TheJobsOwnSkeletonIsNotARequest) {
  submit();
  erode(10, 20);
  const std::int64_t task = ask(store_->job("@last").id(), store_->job("@last").skeleton().threshold());
  store_->withdraw(task);
  EXPECT_EQ(lease().kind(), v1::TASK_KIND_SKELETON);
}

TEST_F(QueueTest, CancellingAFinishedJobTakesItsRequestsBack) {
  const v1::Job done = complete_job(10, 20);
  const std::int64_t task = ask(done.id(), 3);
  EXPECT_EQ(store_->cancel(done.id()).state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(requests(), 0);
  v1::FetchArtifactRequest request = artifact_request(done.id(), v1::ARTIFACT_KIND_SKELETON);
  request.mutable_skeleton()->set_threshold(3);
  EXPECT_STORE_ERROR(store_->open_artifact(request, task), kPrecondition);
  EXPECT_STORE_ERROR(store_->cancel(done.id()), kPrecondition);
}

// No caller waits across a restart; one that asks again in time keeps the work.
TEST_F(QueueTest, RequestsOfARestartedServerAreDroppedUnlessAskedForAgain) {
  const v1::Job done = complete_job(10, 20);
  const std::int64_t kept = ask(done.id(), 3);
  ask(done.id(), 4);
  open();
  store_->expire_leases();
  EXPECT_EQ(requests(), 2);
  EXPECT_EQ(ask(done.id(), 3), kept);
  clock_.advance(options_.orphan_grace_ms);
  store_->expire_leases();
  EXPECT_EQ(requests(), 1);
  EXPECT_EQ(ask(done.id(), 3), kept);
}

TEST_F(QueueTest, OneWorkerHoldsSoManyLeasesAndNoMore) {
  submit();
  prepare(4, 1000);
  for (std::int64_t i = 0; i < options_.max_leases_held; ++i) lease("greedy");
  EXPECT_FALSE(has_work("greedy"));
  EXPECT_TRUE(has_work("modest"));
}

// Renewing is no progress.
TEST_F(QueueTest, ABlockWithoutProgressIsTakenBack) {
  submit();
  prepare(4, 1000);
  const v1::Lease idle = lease("idle"), slow = lease("slow");
  const std::uint64_t begin = slow.positions(0).begin();
  const std::int64_t step = options_.lease_ms - 1;
  std::uint64_t reported = 0;
  for (std::int64_t passed = 0; passed <= options_.stall_ms; passed += step) {
    EXPECT_NO_THROW(store_->renew(idle.token()));
    if (passed > options_.stall_ms / 2 && reported == 0) report(slow, begin, begin + ++reported);
    store_->renew(slow.token());
    clock_.advance(step);
    store_->expire_leases();
  }
  EXPECT_STORE_ERROR(store_->renew(idle.token()), kFenced);
  EXPECT_NO_THROW(store_->renew(slow.token()));
}

// What reports took before, they may take again, ten times over.
TEST_F(QueueTest, DirectionsOfHugeJobsMayTakeLong) {
  options_.stall_ms = 1000;
  open();
  const v1::Job job = submit();
  prepare(4, 1000);
  const v1::Lease block = lease();
  const auto pass = [&](std::int64_t ms) {
    for (std::int64_t passed = 0; passed < ms; passed += 500) {
      clock_.advance(500);
      store_->expire_leases();
      store_->renew(block.token());
    }
  };
  pass(900);
  report(block, block.positions(0).begin(), block.positions(0).begin() + 1);
  EXPECT_EQ(store_->job(job.id()).counters().longest_report_gap_ms(), 1000U);
  pass(9500);
  EXPECT_NO_THROW(store_->renew(block.token()));
  clock_.advance(1001);
  EXPECT_EQ(store_->expire_leases(), 1);
}

}  // namespace
}  // namespace affskel::server
