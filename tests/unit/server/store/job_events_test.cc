#include "store/job_events.h"

#include "expect_store_error.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

class JobEventsTest : public StoreTest {
 protected:
  std::vector<std::string> names(const std::string& job, std::int64_t after = 0) {
    std::vector<std::string> all;
    const v1::ListJobEventsResponse kept = store_->events(job, after);
    for (const v1::JobEvent& event : kept.events()) all.push_back(event.event());
    return all;
  }
  std::vector<v1::JobEvent> events(const std::string& job) {
    const v1::ListJobEventsResponse all = store_->events(job, 0);
    EXPECT_EQ(all.job(), job);
    return {all.events().begin(), all.events().end()};
  }
  v1::JobEvent last(const std::string& job) { return events(job).back(); }
};

using Names = std::vector<std::string>;

TEST_F(JobEventsTest, TellWhatHappenedInOrder) {
  const v1::Job job = submit();
  clock_.advance(7);
  erode(10, 16);  // one block
  derive();
  // erode() leases the skeleton's task once and gives it back.
  EXPECT_EQ(names(job.id()), (Names{"submitted", "leased", "prepared", "finished", "leased", "finished",
                                    "eroded", "leased", "returned", "leased", "finished", "done"}));
  const std::vector<v1::JobEvent> events = this->events(job.id());
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(events[i].number(), i + 1);
    EXPECT_EQ(events[i].time_ms(), job.created_ms() + (i == 0 ? 0 : 7));
  }
  EXPECT_EQ(events[1].kind(), "prepare");
  EXPECT_EQ(events[1].worker(), "worker-a");
  EXPECT_EQ(events[2].message(), "16 triangles, 10 sample points, 16 directions");
  EXPECT_EQ(events[4].kind(), "erode");
  EXPECT_EQ(events[5].task(), events[4].task());
  EXPECT_EQ(events[6].task(), 0U) << "about the job";
}

TEST_F(JobEventsTest, OnlyThoseAfterANumberAndAlsoAfterARestart) {
  const v1::Job job = submit();
  lease();
  EXPECT_EQ(names(job.id(), 1), Names{"leased"});
  EXPECT_EQ(names(job.id(), 2), Names{});
  open();
  EXPECT_EQ(names(job.id()), (Names{"submitted", "leased"}));
}

TEST_F(JobEventsTest, ALostLeaseAndAFailureTellTheirReasons) {
  const v1::Job job = submit();
  const v1::Lease first = lease();
  clock_.advance(options_.lease_ms + 1);
  EXPECT_EQ(store_->expire_leases(), 1);
  EXPECT_EQ(last(job.id()).event(), "lease_lost");
  EXPECT_EQ(last(job.id()).worker(), "worker-a");
  EXPECT_EQ(last(job.id()).message(), "silent for longer than its lease");
  store_->renew(first.token());
  EXPECT_EQ(last(job.id()).event(), "lease_resumed");
  EXPECT_EQ(last(job.id()).worker(), "worker-a");
  clock_.advance(options_.lease_ms + 1);
  v1::JobError error;
  error.set_code("BAD_INPUT");
  error.set_message("line 3: a hole \"here\"");
  store_->fail(lease("worker-b").token(), error, false);
  EXPECT_EQ(names(job.id()), (Names{"submitted", "leased", "lease_lost", "lease_resumed", "lease_lost",
                                    "leased", "task_failed", "failed"}));
  EXPECT_EQ(last(job.id()).message(), "BAD_INPUT: line 3: a hole \"here\"");
}

TEST_F(JobEventsTest, CancelAndResume) {
  const v1::Job job = submit();
  store_->cancel(job.id());
  store_->resume(job.id());
  EXPECT_EQ(names(job.id()), (Names{"submitted", "cancel_requested", "cancelled", "resumed"}));
  submit();  // the same once more
  EXPECT_EQ(last(job.id()).event(), "submitted_again");
}

TEST_F(JobEventsTest, WhatIsNotCommittedDidNotHappen) {
  const v1::Job job = submit();
  const v1::Lease task = lease();
  const Names before = names(job.id());
  PrepareResult result = prepare_result(task.token(), 10, 20);
  result.header.set_order_stride(5);  // not coprime to 20
  EXPECT_STORE_ERROR(store_->complete(result.header, result.data), kInvalid);
  EXPECT_EQ(names(job.id()), before);
}

TEST_F(JobEventsTest, TheFirstAndTheLatestAreKept) {
  const v1::Job job = submit();
  const std::int64_t told = 2 * kMaxJobEvents;
  // Each round is two events.
  for (std::int64_t i = 0; i < told / 2; ++i) store_->give_back(lease().token());
  const std::vector<v1::JobEvent> events = this->events(job.id());
  ASSERT_EQ(static_cast<std::int64_t>(events.size()), kMaxJobEvents);
  for (std::int64_t i = 0; i < kMaxJobEvents; ++i) {
    const std::int64_t left_out = i < kFirstJobEvents ? 0 : told + 1 - kMaxJobEvents;
    EXPECT_EQ(static_cast<std::int64_t>(events[static_cast<std::size_t>(i)].number()), i + 1 + left_out);
  }
}

TEST_F(JobEventsTest, LongMessagesAreCut) {
  const v1::Job job = submit();
  v1::JobError error;
  error.set_code("INTERNAL");
  error.set_message(std::string(3000, 'x'));
  store_->fail(lease().token(), error, false);
  EXPECT_LE(last(job.id()).message().size(), 503U);
}

TEST_F(JobEventsTest, GoWithTheirJob) {
  const v1::Job job = submit();
  store_->cancel(job.id());
  store_->remove(job.id());
  EXPECT_STORE_ERROR(store_->events(job.id(), 0), kNotFound);
  Database db(database(), Database::Mode::kReadOnly);
  EXPECT_EQ(db.integer("SELECT count(*) FROM job_events"), 0);
}

TEST_F(JobEventsTest, AFieldOfAnotherJobIsTakenOver) {
  complete_job(4, 16);
  const v1::Job same = submit("OFF 1", "another name");
  EXPECT_EQ(names(same.id()), (Names{"submitted", "adopted", "done"}));
  v1::SubmitJobHeader header = submit_header("OFF 1", "bob's");
  header.set_owner("bob");
  const v1::Job bobs = store_->submit(header, "OFF 1").job;
  EXPECT_EQ(bobs.state(), v1::JOB_STATE_QUEUED);
  EXPECT_EQ(names(bobs.id()), Names{"submitted"}) << "nothing of the others'";
}

}  // namespace
}  // namespace affskel::server
