#include "job/job_shelf.h"

#include <gtest/gtest.h>

#include "sample_job.h"

namespace affskel::worker {
namespace {

class JobShelfTest : public ::testing::Test {
 protected:
  static std::unique_ptr<PreparedJob> job() {
    return std::make_unique<PreparedJob>(sample_mesh(), sample_params());
  }
  const std::uint64_t each_ = bytes_of(*job());
};

TEST_F(JobShelfTest, GivesTheSameJobBackOnce) {
  JobShelf shelf(2 * each_);
  std::unique_ptr<PreparedJob> first = job();
  const PreparedJob* const address = first.get();
  shelf.put({"a", "db", std::move(first)});
  EXPECT_EQ(shelf.bytes(), each_);
  EXPECT_EQ(shelf.take("b", "db"), nullptr);
  EXPECT_EQ(shelf.take("a", "db").get(), address);
  EXPECT_EQ(shelf.take("a", "db"), nullptr);
  EXPECT_EQ(shelf.bytes(), 0U);
}

// The server's database was put back: what the field knows may be news to it.
TEST_F(JobShelfTest, AFieldFromAnotherDatabaseIsNotUsed) {
  JobShelf shelf(2 * each_);
  std::unique_ptr<PreparedJob> left = job();
  left->erosion(1, {});
  shelf.put({"a", "before", std::move(left)});
  const std::unique_ptr<PreparedJob> back = shelf.take("a", "after");
  ASSERT_NE(back, nullptr) << "what follows from the mesh is kept";
  EXPECT_FALSE(back->has_erosion());
  EXPECT_EQ(shelf.bytes(), 0U);
}

TEST_F(JobShelfTest, WhatWasLeftLongestAgoGoesFirst) {
  JobShelf shelf(2 * each_);
  for (const char* id : {"a", "b", "c"}) shelf.put({id, "db", job()});
  EXPECT_EQ(shelf.take("a", "db"), nullptr);
  EXPECT_NE(shelf.take("b", "db"), nullptr);
  EXPECT_NE(shelf.take("c", "db"), nullptr);
}

TEST_F(JobShelfTest, AJobTooLargeIsNotKept) {
  JobShelf shelf(each_ - 1);
  shelf.put({"a", "db", job()});
  EXPECT_EQ(shelf.bytes(), 0U);
}

}  // namespace
}  // namespace affskel::worker
