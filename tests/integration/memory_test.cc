// A worker with too little memory leaves a job to a larger one.
#include <gtest/gtest.h>

#include <thread>

#include "lab.h"

namespace affskel::integration {
namespace {

constexpr const char* kCube =
    "OFF\n8 12 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n"
    "3 0 2 1\n3 1 2 3\n3 4 5 6\n3 5 7 6\n3 0 1 4\n3 1 5 4\n3 2 6 3\n3 3 6 7\n3 0 4 2\n3 2 4 6\n3 1 3 5\n3 3 "
    "7 5\n";

TEST(MemoryTest, AJobWaitsForAWorkerThatItFits) {
  const Lab lab;
  const Process server = lab.server();
  const Process small = lab.worker({"--threads", "1", "--memory", "70M"});
  lab.write("cube.off", kCube);
  // 1.5 million points, which the spacing does not tell before the mesh is read; the ridge of so many takes long.
  const Output submitted =
      lab.client({"submit", lab.path("cube.off"), "--spacing", "0.00875", "--operator", "central"});
  ASSERT_EQ(submitted.exit_code, 0) << submitted.err;
  const std::string id = submitted.out.substr(0, submitted.out.find('\n'));
  v1::Job job = lab.job(id);
  while (job.waiting_reason().find("needs a worker with about") == std::string::npos) {
    ASSERT_NE(job.state(), v1::JOB_STATE_FAILED) << job.error().message();
    ASSERT_NE(job.state(), v1::JOB_STATE_DONE);
    std::this_thread::yield();
    job = lab.job(id);
  }
  EXPECT_NE(job.waiting_reason().find("the largest of 1 has 73 MB"), std::string::npos)
      << job.waiting_reason();
  EXPECT_GT(job.memory_needed(), std::uint64_t{70} << 20);
  EXPECT_NE(lab.client({"status", id}).out.find("needs a worker with about"), std::string::npos);
  const Process large = lab.worker({"--threads", "1"});
  const v1::Job done = lab.follow_to_end(id);
  EXPECT_EQ(done.state(), v1::JOB_STATE_DONE) << done.error().message();
  EXPECT_GT(done.prepared().points(), 1'400'000U);
}

}  // namespace
}  // namespace affskel::integration
