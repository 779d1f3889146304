// The infimum over all directions by the real programs, undisturbed and amid kills, against the same without a server.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "lab.h"

namespace affskel::integration {
namespace {

constexpr const char* kInfimumPoints = "15000";

// A moment of the refinement: a round, and the share of its points that is done.
struct Moment {
  std::uint32_t round;
  double share;
};
constexpr Moment kRoundMoments[] = {{0, 0.1}, {0, 0.6}, {1, 0.2}, {2, 0}};

bool has_come(const v1::Job& job, const Moment& moment) {
  if (job.refine_round() != moment.round) return job.refine_round() > moment.round;
  return job.stage() == v1::JOB_STAGE_REFINE &&
         static_cast<double>(job.refined_points()) >=
             moment.share * static_cast<double>(job.prepared().points());
}

class InfimumTest : public testing::Test {
 protected:
  // A job of some seconds, and its field computed without any server.
  void SetUp() override {
    const Output made =
        lab_.run({AFFSKEL_CLIENT_BINARY, "make", "body", "--triangles", "1000", "-o", lab_.path("m.off")});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const Output plain =
        lab_.run({AFFSKEL_WORKER_BINARY, "compute", lab_.path("m.off"), "--points", kInfimumPoints,
                  "--minimum", "infimum", "--threads", "2", "-o", lab_.path("plain.csv")});
    ASSERT_EQ(plain.exit_code, 0) << plain.err;
  }

  std::string submit() const { return lab_.submit({"--points", kInfimumPoints, "--minimum", "infimum"}); }

  v1::Job follow_to(const std::string& id, const Moment& moment) const {
    return lab_.follow(id, [&](const v1::Job& job) { return has_come(job, moment); });
  }

  void expect_undisturbed_field(const std::string& id) const {
    const v1::Job job = lab_.follow_to_end(id);
    ASSERT_EQ(job.state(), v1::JOB_STATE_DONE) << job.error().message();
    const Output fetched = lab_.client({"fetch", id, "field", "-o", lab_.path("field.csv")});
    ASSERT_EQ(fetched.exit_code, 0) << fetched.err;
    EXPECT_TRUE(lab_.read("field.csv") == lab_.read("plain.csv")) << "the fields differ";
    const Output checked = lab_.run({AFFSKEL_SERVER_BINARY, "check", "--data-dir", lab_.path("data")});
    EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
  }

  Lab lab_;
};

// No lease ends by itself, however slow the machine; for workers whose death the server does not see, and leases whose
// answer a killed server has not sent.
const std::vector<std::string> kInfimumQuick = {"--lease-ms", "60000", "--report-interval-ms", "50"};
const std::vector<std::string> kInfimumShort = {"--lease-ms", "1000", "--report-interval-ms", "50"};

TEST_F(InfimumTest, TwoWorkersGiveWhatOneProgramGives) {
  const Process server = lab_.server(kInfimumQuick);
  const Process one = lab_.worker(), other = lab_.worker({"--threads", "2"});
  const std::string id = submit();
  expect_undisturbed_field(id);
  EXPECT_NE(id, lab_.submit({"--points", kInfimumPoints}));
  EXPECT_EQ(id, submit());
  const std::string log = lab_.client({"log", id}).out;
  EXPECT_NE(log.find("refined"), std::string::npos) << log;
  EXPECT_NE(lab_.client({"status", id}).out.find("asked_minimum"), std::string::npos);
}

TEST_F(InfimumTest, OneOfTwoWorkersIsKilledAmidTheRounds) {
  const Process server = lab_.server(kInfimumShort);
  const Process steady = lab_.worker();
  Process worker = lab_.worker();
  const std::string id = submit();
  for (const Moment& moment : kRoundMoments) {
    ASSERT_EQ(follow_to(id, moment).state(), v1::JOB_STATE_RUNNING) << "the job was over before the blow";
    worker.kill_hard();
    worker = lab_.worker();
  }
  expect_undisturbed_field(id);
}

TEST_F(InfimumTest, TheServerIsKilledAmidTheRounds) {
  Process server = lab_.server(kInfimumShort);
  const Process worker = lab_.worker();
  const std::string id = submit();
  for (const Moment& moment : kRoundMoments) {
    const v1::Job job = follow_to(id, moment);
    ASSERT_EQ(job.state(), v1::JOB_STATE_RUNNING) << "the job was over before the blow";
    server.kill_hard();
    server = lab_.server(kInfimumShort);
    const v1::Job after = lab_.job(id);
    EXPECT_GE(after.refine_round(), job.refine_round());
    if (after.refine_round() == job.refine_round()) {
      EXPECT_GE(after.refined_points(), job.refined_points()) << "acknowledged work was lost";
    }
  }
  expect_undisturbed_field(id);
}

// What a distrusted worker has refined is computed again by others.
TEST_F(InfimumTest, TheRefinementOfADistrustedWorkerIsTakenBack) {
  const Process server = lab_.server(kInfimumQuick);
  Process first = lab_.worker();
  const std::string id = submit();
  ASSERT_EQ(lab_.follow_to_end(id).state(), v1::JOB_STATE_DONE);
  const v1::Giver giver = lab_.only_giver(id);
  EXPECT_GT(giver.points(), 15000U * 9 / 10);
  first.kill_hard();
  const Process second = lab_.worker();
  EXPECT_EQ(lab_.client({"resume", id, "--distrust", giver.worker()}).exit_code, 0);
  expect_undisturbed_field(id);
}

}  // namespace
}  // namespace affskel::integration
