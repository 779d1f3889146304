#include "job/task_limit.h"

#include <gtest/gtest.h>

#include <atomic>

#include "tasks/failure.h"

namespace affskel::worker {
namespace {

using Code = core::CoreError::Code;
using std::chrono::seconds;

class Task : public core::ExecutionContext {
 public:
  bool stop_requested() override { return stopped; }
  std::atomic<bool> stopped{false};
};

const core::CoreError kStopped(Code::kCancelled, "stopped before the end");

class TaskLimitTest : public testing::Test {
 protected:
  TaskLimit limit(seconds bound) {
    return {task_, bound, kPreparing, [this] { return std::chrono::nanoseconds(now_); }};
  }

  Task task_;
  seconds now_{1000};  // taken before
};

TEST_F(TaskLimitTest, StopsWhatTakesLonger) {
  TaskLimit bound = limit(seconds(10));
  now_ += seconds(10);
  EXPECT_FALSE(bound.stop_requested());
  now_ += seconds(1);
  EXPECT_TRUE(bound.stop_requested());
  const core::CoreError reason = bound.reason(kStopped);
  EXPECT_EQ(reason.code(), Code::kLimit);
  EXPECT_NE(std::string(reason.what()).find("10 s of processor time"), std::string::npos) << reason.what();
}

TEST_F(TaskLimitTest, SaysWhatItIsOf) {
  TaskLimit bound(task_, seconds(3), kDeriving, [this] { return std::chrono::nanoseconds(now_); });
  now_ += seconds(4);
  const std::string reason = bound.reason(kStopped).what();
  EXPECT_EQ(reason.find("making this of the field takes more than 3 s"), 0U) << reason;
  EXPECT_NE(reason.find("--derive-limit"), std::string::npos) << reason;
}

TEST_F(TaskLimitTest, FailsTheJobForGood) {
  TaskLimit bound = limit(seconds(10));
  now_ += seconds(11);
  const Failure failure = describe(std::make_exception_ptr(bound.reason(kStopped)), {});
  EXPECT_EQ(failure.error.code(), "LIMIT");
  EXPECT_FALSE(failure.retryable);
}

TEST_F(TaskLimitTest, ZeroIsNoBound) {
  TaskLimit bound = limit(seconds(0));
  now_ += seconds(1000000);
  EXPECT_FALSE(bound.stop_requested());
}

TEST_F(TaskLimitTest, LeavesOtherReasonsAsTheyAre) {
  TaskLimit bound = limit(seconds(10));
  EXPECT_EQ(bound.reason(kStopped).code(), Code::kCancelled);
  now_ += seconds(11);
  EXPECT_EQ(bound.reason({Code::kBadInput, "a hole"}).code(), Code::kBadInput);
  // A worker that leaves gives the task back, however long it took.
  task_.stopped = true;
  EXPECT_TRUE(bound.stop_requested());
  EXPECT_EQ(bound.reason(kStopped).code(), Code::kCancelled);
}

// What sleeps or waits for its turn takes none.
TEST(ProcessorTime, GrowsWithWork) {
  const auto before = processor_time();
  while (processor_time() - before < std::chrono::milliseconds(1)) {
  }
  EXPECT_GT(processor_time(), before);
}

}  // namespace
}  // namespace affskel::worker
