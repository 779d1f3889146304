// A disk that the service itself fills: everything that is needed to recover goes through the product.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "lab.h"

namespace affskel::integration {
namespace {

constexpr int kLimit = 8;

class FullDiskTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!lab_.can_mount()) GTEST_SKIP() << kCannotMount;
    lab_.make_torus(512);
  }

  Output submit(const std::string& points) const {
    Output submitted = lab_.client({"submit", lab_.path("m.off"), "--points", points});
    submitted.out = submitted.out.substr(0, submitted.out.find('\n'));
    return submitted;
  }

  static bool is_stuck(const v1::Job& job) {
    return job.waiting_reason().find("disk is full") != std::string::npos;
  }

  // Of the server's own disk, as it sees it.
  std::uintmax_t free_bytes(const Process& server) const {
    return std::filesystem::space("/proc/" + std::to_string(server.pid()) + "/root" + lab_.path("disk/data"))
        .available;
  }

  Lab lab_;
};

// The directory itself takes two, the last number lets the database be made but not server.json.
TEST_F(FullDiskTest, AStartWithoutInodesIsForAServiceManagerToRepeat) {
  for (int inodes = 2; inodes <= 8; ++inodes) {
    SCOPED_TRACE(inodes);
    const Output start =
        lab_.run(lab_.on_small_disk("size=64m,nr_inodes=" + std::to_string(inodes),
                                    {AFFSKEL_SERVER_BINARY, "--data-dir", lab_.path("disk/data"), "--listen",
                                     lab_.address(), "--idle-exit", "0"}));
    EXPECT_EQ(start.exit_code, kLimit) << start.err;
    EXPECT_TRUE(start.err.find("No space left") != std::string::npos ||
                start.err.find("inodes") != std::string::npos)
        << start.err;
  }
}

// The field of the large job alone is 60 MB, its first report 72 MB, and they go through a log.
TEST_F(FullDiskTest, CancelAndDeleteMakeRoomForTheNextJob) {
  const Process server = lab_.server_on_small_disk("100m", {"--workers", "1"});
  const Output small = submit("20000");
  ASSERT_EQ(small.exit_code, 0) << small.err;
  ASSERT_EQ(lab_.follow_to_end(small.out).state(), v1::JOB_STATE_DONE);
  ASSERT_EQ(lab_.client({"fetch", small.out, "field", "-o", lab_.path("before.csv")}).exit_code, 0);
  const std::uintmax_t free = free_bytes(server);

  const Output large = submit("3000000");
  ASSERT_EQ(large.exit_code, 0) << large.err;
  ASSERT_TRUE(is_stuck(lab_.follow(large.out, is_stuck)));
  // Not at the first look, perhaps: what the failed report had taken is tried once more.
  while (lab_.client({"status", large.out}).out.find("disk is full") == std::string::npos) {
    ASSERT_EQ(lab_.job(large.out).state(), v1::JOB_STATE_RUNNING);
  }

  EXPECT_EQ(lab_.client({"cancel", large.out}).exit_code, 0);
  EXPECT_EQ(lab_.follow_to_end(large.out).state(), v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(lab_.client({"delete", large.out}).exit_code, 0);
  while (free_bytes(server) + (std::uintmax_t{1} << 20) < free) {
    ASSERT_EQ(lab_.client({"server-info"}).exit_code, 0) << "it gives bytes back, and answers meanwhile";
  }

  const Output next = submit("21000");
  ASSERT_EQ(next.exit_code, 0) << next.err;
  EXPECT_EQ(lab_.follow_to_end(next.out).state(), v1::JOB_STATE_DONE);
  ASSERT_EQ(lab_.client({"fetch", small.out, "field", "-o", lab_.path("after.csv")}).exit_code, 0);
  EXPECT_TRUE(lab_.read("before.csv") == lab_.read("after.csv"));
}

TEST_F(FullDiskTest, WhatCannotBeStoredIsRefusedWithTheRemedy) {
  const Process server = lab_.server_on_small_disk("40m");
  lab_.write("large.off", lab_.read("m.off") + std::string(std::size_t{24} << 20, '\n'));
  const Output refused = lab_.client({"submit", lab_.path("large.off"), "--points", "1000"});
  EXPECT_EQ(refused.exit_code, kLimit);
  EXPECT_NE(refused.err.find("delete jobs"), std::string::npos) << refused.err;
  EXPECT_EQ(submit("1000").exit_code, 0) << "a small one still finds room";
}

}  // namespace
}  // namespace affskel::integration
