#include "ledger.h"

#include <gtest/gtest.h>

namespace affskel::chaos {
namespace {

v1::Job job(const std::string& id, const std::string& name, v1::JobState state, std::uint64_t done = 0) {
  v1::Job job;
  job.set_id(id);
  job.set_name(name);
  job.set_mesh_sha256("mesh");
  job.set_state(state);
  job.set_directions_total(100);
  job.set_directions_done(done);
  if (done > 0) job.add_done_positions()->set_end(done);
  return job;
}

class LedgerTest : public testing::Test {
 protected:
  void SetUp() override {
    EXPECT_TRUE(ledger_.submitted("a", "mesh", 0, job("1", "a", v1::JOB_STATE_QUEUED)).empty());
  }

  Ledger ledger_;
};

TEST_F(LedgerTest, WhatGoesOnIsNoFault) {
  EXPECT_TRUE(ledger_.audit({job("1", "a", v1::JOB_STATE_QUEUED)}).empty());
  EXPECT_TRUE(ledger_.audit({job("1", "a", v1::JOB_STATE_RUNNING, 10)}).empty());
  EXPECT_TRUE(ledger_.audit({job("1", "a", v1::JOB_STATE_DONE, 100)}).empty());
}

TEST_F(LedgerTest, AMissingJobIsReported) {
  EXPECT_EQ(ledger_.audit({}).size(), 1U);
}

TEST_F(LedgerTest, AnotherMeshIsReported) {
  v1::Job other = job("1", "a", v1::JOB_STATE_QUEUED);
  other.set_mesh_sha256("other");
  EXPECT_EQ(ledger_.audit({other}).size(), 1U);
}

TEST_F(LedgerTest, ASecondJobOfOneSubmissionIsReported) {
  EXPECT_EQ(ledger_.submitted("a", "mesh", 0, job("2", "a", v1::JOB_STATE_QUEUED)).size(), 1U);
  EXPECT_FALSE(
      ledger_.audit({job("1", "a", v1::JOB_STATE_QUEUED), job("2", "a", v1::JOB_STATE_QUEUED)}).empty());
}

TEST_F(LedgerTest, AnAnswerByAnotherJobIsReported) {
  EXPECT_EQ(ledger_.submitted("b", "mesh", 0, job("1", "a", v1::JOB_STATE_QUEUED)).size(), 1U);
}

TEST_F(LedgerTest, ProgressThatFallsIsReported) {
  ledger_.saw(job("1", "a", v1::JOB_STATE_RUNNING, 50));
  EXPECT_EQ(ledger_.audit({job("1", "a", v1::JOB_STATE_RUNNING, 49)}).size(), 1U);
}

TEST_F(LedgerTest, ARefinementThatFallsBackIsReported) {
  const auto refining = [](std::uint32_t round, std::uint64_t points) {
    v1::Job refined = job("1", "a", v1::JOB_STATE_RUNNING, 100);
    refined.set_refine_round(round);
    refined.set_refined_points(points);
    return refined;
  };
  ledger_.saw(refining(2, 40));
  EXPECT_TRUE(ledger_.audit({refining(3, 0)}).empty());
  EXPECT_EQ(ledger_.audit({refining(2, 39)}).size(), 1U);
}

TEST_F(LedgerTest, ADirectionDoneNoMoreIsReportedEvenWhenTheNumberIsLarger) {
  ledger_.saw(job("1", "a", v1::JOB_STATE_RUNNING, 50));
  v1::Job other = job("1", "a", v1::JOB_STATE_RUNNING, 60);
  other.mutable_done_positions(0)->set_begin(1);
  other.mutable_done_positions(0)->set_end(61);
  EXPECT_EQ(ledger_.audit({other}).size(), 1U);
}

TEST_F(LedgerTest, AnEarlierAnswerThatArrivesLateDoesNoHarm) {
  ledger_.saw(job("1", "a", v1::JOB_STATE_RUNNING, 50));
  ledger_.saw(job("1", "a", v1::JOB_STATE_RUNNING, 20));
  EXPECT_EQ(ledger_.audit({job("1", "a", v1::JOB_STATE_RUNNING, 30)}).size(), 1U);
}

TEST_F(LedgerTest, ADoneJobStaysDone) {
  ledger_.saw(job("1", "a", v1::JOB_STATE_DONE, 100));
  EXPECT_FALSE(ledger_.audit({job("1", "a", v1::JOB_STATE_RUNNING, 100)}).empty());
}

TEST_F(LedgerTest, ADoneJobHasAllItsDirections) {
  EXPECT_EQ(ledger_.audit({job("1", "a", v1::JOB_STATE_DONE, 99)}).size(), 1U);
}

TEST_F(LedgerTest, ACancelHolds) {
  ledger_.cancelled(job("1", "a", v1::JOB_STATE_CANCELLED));
  EXPECT_TRUE(ledger_.audit({job("1", "a", v1::JOB_STATE_CANCELLED)}).empty());
  EXPECT_EQ(ledger_.audit({job("1", "a", v1::JOB_STATE_RUNNING)}).size(), 1U);
  EXPECT_EQ(ledger_.audit({job("1", "a", v1::JOB_STATE_DONE, 100)}).size(), 1U);
}

TEST_F(LedgerTest, AJobThatWasOnlyMarkedMayHaveBeenDone) {
  ledger_.cancelled(job("1", "a", v1::JOB_STATE_RUNNING));
  EXPECT_TRUE(ledger_.audit({job("1", "a", v1::JOB_STATE_DONE, 100)}).empty());
}

TEST_F(LedgerTest, AResumeHolds) {
  ledger_.cancelled(job("1", "a", v1::JOB_STATE_CANCELLED));
  ledger_.resumed(job("1", "a", v1::JOB_STATE_QUEUED));
  EXPECT_EQ(ledger_.audit({job("1", "a", v1::JOB_STATE_CANCELLED)}).size(), 1U);
}

TEST_F(LedgerTest, ADeletedJobStaysAway) {
  ledger_.deleting("1");
  EXPECT_TRUE(ledger_.audit({}).empty());
  EXPECT_TRUE(ledger_.audit({job("1", "a", v1::JOB_STATE_CANCELLED)}).size() <= 1);
  ledger_.deleted("1");
  EXPECT_TRUE(ledger_.audit({}).empty());
  EXPECT_EQ(ledger_.audit({job("1", "a", v1::JOB_STATE_QUEUED)}).size(), 1U);
}

TEST_F(LedgerTest, AFailureIsReportedUnlessItsWorkersWereLost) {
  v1::Job failed = job("1", "a", v1::JOB_STATE_FAILED);
  failed.mutable_error()->set_code("INTERNAL");
  EXPECT_EQ(ledger_.audit({failed}).size(), 1U);
  failed.mutable_error()->set_code("WORKER_LOST");
  EXPECT_TRUE(ledger_.audit({failed}).empty());
}

TEST(Difference, NamesTheFirstByte) {
  const std::string field(1000, 'x');
  EXPECT_FALSE(difference(field, field));
  std::string flipped = field;
  flipped[700] ^= 1;
  ASSERT_TRUE(difference(flipped, field));
  EXPECT_NE(difference(flipped, field)->find("byte 700 "), std::string::npos);
  EXPECT_TRUE(difference(field.substr(1), field));
  EXPECT_TRUE(difference("", field));
}

}  // namespace
}  // namespace affskel::chaos
