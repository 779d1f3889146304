// Kills the real programs at awkward moments and compares the finished field with an undisturbed run.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "lab.h"

namespace affskel::integration {
namespace {

constexpr const char* kPoints = "100000";
constexpr const char* kDirections = "triangles+sphere:8000";

// Shares of the job after which the blow falls.
constexpr double kMoments[] = {0.03, 0.4, 0.8};

class CrashTest : public testing::Test {
 protected:
  // A job of some seconds, and its field computed without any server.
  void SetUp() override {
    lab_.make_torus(2048);
    const Output plain = lab_.run({AFFSKEL_WORKER_BINARY, "compute", lab_.path("m.off"), "--points", kPoints,
                                   "--directions", kDirections, "-o", lab_.path("plain.csv")});
    ASSERT_EQ(plain.exit_code, 0) << plain.err;
  }

  std::string submit() const { return lab_.submit({"--points", kPoints, "--directions", kDirections}); }

  void expect_undisturbed_field(const std::string& id) const {
    const v1::Job job = lab_.follow_to_end(id);
    ASSERT_EQ(job.state(), v1::JOB_STATE_DONE) << job.error().message();
    EXPECT_EQ(job.directions_done(), job.directions_total());
    const Output fetched = lab_.client({"fetch", id, "field", "-o", lab_.path("field.csv")});
    ASSERT_EQ(fetched.exit_code, 0) << fetched.err;
    EXPECT_TRUE(lab_.read("field.csv") == lab_.read("plain.csv")) << "the fields differ";
    const Output checked = lab_.run({AFFSKEL_SERVER_BINARY, "check", "--data-dir", lab_.path("data")});
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
  }

  // Kills the worker at each of the moments and starts another in its place.
  void kill_three_times(Process& worker, const std::string& id) const {
    for (double moment : kMoments) {
      const v1::Job job = lab_.follow_to_share(id, moment);
      ASSERT_EQ(job.state(), v1::JOB_STATE_RUNNING) << "the job was over before the blow";
      worker.kill_hard();
      worker = lab_.worker();
    }
  }

  Lab lab_;
};

// No lease ends by itself, however slow the machine.
const std::vector<std::string> kQuickReports = {"--lease-ms", "60000", "--report-interval-ms", "50"};
// For workers whose death the server does not see.
const std::vector<std::string> kShortLeases = {"--lease-ms", "1000", "--report-interval-ms", "50"};

TEST_F(CrashTest, TheOnlyWorkerIsKilledThreeTimes) {
  Process server = lab_.server(kShortLeases);
  Process worker = lab_.worker();
  const std::string id = submit();
  kill_three_times(worker, id);
  expect_undisturbed_field(id);
}

TEST_F(CrashTest, OneOfTwoWorkersIsKilledThreeTimes) {
  Process server = lab_.server(kShortLeases);
  Process steady = lab_.worker();
  Process worker = lab_.worker();
  const std::string id = submit();
  kill_three_times(worker, id);
  expect_undisturbed_field(id);
}

// For longer than its lease, and no other worker takes its work.
TEST_F(CrashTest, TheOnlyWorkerStandsStillThreeTimes) {
  const Process server = lab_.server(kShortLeases);
  const Process worker = lab_.worker();
  const std::string id = submit();
  for (double moment : kMoments) {
    const v1::Job job = lab_.follow_to_share(id, moment);
    ASSERT_EQ(job.state(), v1::JOB_STATE_RUNNING) << "the job was over before the blow";
    worker.send(SIGSTOP);
    lab_.follow(id,
                [&](const v1::Job& j) { return j.counters().leases_lost() > job.counters().leases_lost(); });
    worker.send(SIGCONT);
  }
  expect_undisturbed_field(id);
  EXPECT_NE(lab_.client({"--json", "log", id}).out.find("lease_resumed"), std::string::npos);
}

TEST_F(CrashTest, TheServerIsKilledThreeTimes) {
  Process server = lab_.server(kQuickReports);
  const Process worker = lab_.worker();
  const std::string id = submit();
  std::uint64_t acknowledged = 0;
  for (double moment : kMoments) {
    const v1::Job job = lab_.follow_to_share(id, moment);
    ASSERT_EQ(job.state(), v1::JOB_STATE_RUNNING) << "the job was over before the blow";
    EXPECT_GE(job.directions_done(), acknowledged);
    acknowledged = job.directions_done();
    server.kill_hard();
    server = lab_.server(kQuickReports);
    EXPECT_GE(lab_.job(id).directions_done(), acknowledged) << "acknowledged work was lost";
  }
  expect_undisturbed_field(id);
}

TEST_F(CrashTest, AServerWithItsOwnWorkersIsKilledThreeTimes) {
  std::vector<std::string> options = kQuickReports;
  options.insert(options.end(), {"--workers", "1"});
  Process server = lab_.server(options);
  const std::string id = submit();
  for (double moment : kMoments) {
    const v1::Job job = lab_.follow_to_share(id, moment);
    ASSERT_EQ(job.state(), v1::JOB_STATE_RUNNING) << "the job was over before the blow";
    server.kill_hard();
    server = lab_.server(options);
  }
  expect_undisturbed_field(id);
}

// With the intervals that users get: the supervisor sees its worker die, so nothing waits for a deadline.
TEST_F(CrashTest, ASupervisedWorkerIsKilledThreeTimes) {
  const Process server = lab_.server({"--workers", "1"});
  const std::string id = submit();
  for (double moment : kMoments) {
    const v1::Job job = lab_.follow_to_share(id, moment);
    ASSERT_EQ(job.state(), v1::JOB_STATE_RUNNING) << "the job was over before the blow";
    grpc::ClientContext context;
    v1::ServerInfo info;
    ASSERT_TRUE(lab_.stub().GetServerInfo(&context, {}, &info).ok());
    for (const v1::WorkerInfo& worker : info.workers()) kill(static_cast<pid_t>(worker.pid()), SIGKILL);
  }
  expect_undisturbed_field(id);
  const v1::JobCounters counters = lab_.job(id).counters();
  EXPECT_EQ(counters.directions_repeated(), 0U) << "what was reported is never computed again";
  EXPECT_LE(counters.leases_lost(), 9U)
      << "a worker reports one block, computes the next, and may just have asked for another";
}

TEST_F(CrashTest, WorkersAndServerLeaveInOrderAtSigterm) {
  Process server = lab_.server(kQuickReports);
  Process worker = lab_.worker();
  const std::string id = submit();
  lab_.follow(id, [](const v1::Job& j) { return j.directions_done() > 100; });
  worker.send(SIGTERM);
  EXPECT_EQ(worker.wait(), 0);
  const v1::Job stopped = lab_.job(id);
  EXPECT_EQ(stopped.counters().leases_lost(), 0U);
  server.send(SIGTERM);
  EXPECT_EQ(server.wait(), 0);
  server = lab_.server(kQuickReports);
  EXPECT_EQ(lab_.job(id).directions_done(), stopped.directions_done());
  worker = lab_.worker();
  expect_undisturbed_field(id);
  EXPECT_EQ(lab_.job(id).counters().directions_repeated(), 0U);
}

TEST_F(CrashTest, ACancelledJobKeepsItsProgressAndGoesOn) {
  const Process server = lab_.server(kQuickReports);
  const Process worker = lab_.worker();
  const std::string id = submit();
  lab_.follow(id, [](const v1::Job& j) { return j.directions_done() > 100; });
  const Output cancelled = lab_.client({"cancel", id});
  EXPECT_EQ(cancelled.exit_code, 0) << cancelled.err;
  const v1::Job stopped = lab_.follow_to_end(id);
  ASSERT_EQ(stopped.state(), v1::JOB_STATE_CANCELLED);
  EXPECT_GT(stopped.directions_done(), 100U);
  EXPECT_LT(stopped.directions_done(), stopped.directions_total());
  EXPECT_EQ(lab_.client({"fetch", id, "field", "-o", lab_.path("none.csv")}).exit_code, 4);
  EXPECT_EQ(lab_.client({"resume", id}).exit_code, 0);
  expect_undisturbed_field(id);
  EXPECT_EQ(lab_.job(id).counters().directions_repeated(), 0U);
}

TEST_F(CrashTest, TheFieldDoesNotDependOnWhoComputesIt) {
  {
    const Process server = lab_.server({"--workers", "2"});
    expect_undisturbed_field(submit());
  }
  std::filesystem::remove_all(lab_.path("data"));
  {
    const Process server = lab_.server({"--workers", "1", "--worker-threads", "2"});
    expect_undisturbed_field(submit());
  }
  const Output shuffled =
      lab_.run({AFFSKEL_WORKER_BINARY, "compute", lab_.path("m.off"), "--points", kPoints, "--directions",
                kDirections, "--threads", "2", "--shuffle", "-o", lab_.path("field.csv")});
  ASSERT_EQ(shuffled.exit_code, 0) << shuffled.err;
  EXPECT_TRUE(lab_.read("field.csv") == lab_.read("plain.csv"));
}

}  // namespace
}  // namespace affskel::integration
