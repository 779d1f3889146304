// Results that were removed and are computed again.
#include <gtest/gtest.h>

#include <thread>

#include "lab.h"

namespace affskel::integration {
namespace {

// The worker has held the field from before, which the server no longer knows.
TEST(RetentionTest, TheSameWorkerComputesRemovedResultsAgain) {
  const Lab lab;
  const Process server = lab.server({"--retention", "results-age=1s", "--retention", "grace=0s"});
  const Process worker = lab.worker({"--threads", "1"});
  lab.make_torus(256);
  const std::string id = lab.submit({"--points", "2000"});
  ASSERT_EQ(lab.client({"pin", id}).exit_code, 0);
  ASSERT_EQ(lab.follow_to_end(id).state(), v1::JOB_STATE_DONE);
  ASSERT_EQ(lab.client({"fetch", id, "field", "-o", lab.path("before.csv")}).exit_code, 0);
  ASSERT_EQ(lab.client({"unpin", id}).exit_code, 0);
  while (lab.job(id).removed_ms() == 0) std::this_thread::yield();
  ASSERT_EQ(lab.client({"resume", id}).exit_code, 0);
  ASSERT_EQ(lab.client({"pin", id}).exit_code, 0);
  EXPECT_EQ(lab.follow_to_end(id).state(), v1::JOB_STATE_DONE);
  const Output fetched = lab.client({"fetch", id, "field", "-o", lab.path("after.csv")});
  ASSERT_EQ(fetched.exit_code, 0) << fetched.err;
  EXPECT_TRUE(lab.read("after.csv") == lab.read("before.csv"));
  const Output check = lab.run({AFFSKEL_SERVER_BINARY, "check", "--data-dir", lab.path("data")});
  EXPECT_EQ(check.exit_code, 0) << check.err;
}

}  // namespace
}  // namespace affskel::integration
