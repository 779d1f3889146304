// Servers that stop in order and come back: for clients and workers a pause.
#include <gtest/gtest.h>

#include <csignal>
#include <thread>
#include <vector>

#include "lab.h"

namespace affskel::integration {
namespace {

constexpr int kRestarts = 25;
constexpr std::size_t kWorkers = 6;

class RestartTest : public testing::Test {
 protected:
  /// Workers of one thread each.
  std::vector<Process> workers() const {
    std::vector<Process> started;
    for (std::size_t i = 0; i < kWorkers; ++i) started.push_back(lab_.worker({"--threads", "1"}));
    return started;
  }

  std::size_t known_workers() const {
    grpc::ClientContext context;
    context.set_wait_for_ready(true);
    v1::ServerInfo info;
    EXPECT_TRUE(lab_.stub().GetServerInfo(&context, {}, &info).ok());
    return static_cast<std::size_t>(info.workers_size());
  }

  /// The server has forgotten them; each is heard from again when it asks for work.
  void wait_for_workers() const {
    while (known_workers() < kWorkers) std::this_thread::yield();
  }

  static void expect_all_running(const std::vector<Process>& workers) {
    for (const Process& worker : workers) EXPECT_TRUE(worker.running());
  }

  static void stop_in_order(Process& server) {
    server.send(SIGTERM);
    EXPECT_EQ(server.wait(), 0);
  }

  Lab lab_;
};

TEST_F(RestartTest, IdleWorkersSurviveGracefulRestarts) {
  Process server = lab_.server();
  const std::vector<Process> all = workers();
  for (int i = 0; i < kRestarts; ++i) {
    wait_for_workers();
    stop_in_order(server);
    server = lab_.server();
  }
  wait_for_workers();
  expect_all_running(all);
}

// No task fails, and the job ends with the field that it would have had.
TEST_F(RestartTest, BusyWorkersSurviveGracefulRestarts) {
  lab_.make_torus(512);
  const std::vector<std::string> params = {"--points", "30000", "--directions", "sphere:4000"};
  std::vector<std::string> compute = {AFFSKEL_WORKER_BINARY, "compute", lab_.path("m.off"), "-o",
                                      lab_.path("plain.csv")};
  compute.insert(compute.end(), params.begin(), params.end());
  ASSERT_EQ(lab_.run(compute).exit_code, 0);
  Process server = lab_.server();
  const std::vector<Process> all = workers();
  const std::string id = lab_.submit(params);
  for (const double moment : {0.05, 0.2, 0.4, 0.6, 0.8}) {
    lab_.follow_to_share(id, moment);
    stop_in_order(server);
    server = lab_.server();
  }
  EXPECT_EQ(lab_.follow_to_end(id).state(), v1::JOB_STATE_DONE);
  expect_all_running(all);
  ASSERT_EQ(lab_.client({"fetch", id, "field", "-o", lab_.path("field.csv")}).exit_code, 0);
  EXPECT_TRUE(lab_.read("field.csv") == lab_.read("plain.csv")) << "the fields differ";
}

}  // namespace
}  // namespace affskel::integration
