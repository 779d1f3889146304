// What operators see of a real server and its workers: metrics, logs, the events of a job.
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "lab.h"
#include "tools/exposition.h"
#include "tools/http_get.h"
#include "tools/logfmt_parser.h"
#include "wire/sha256.h"

namespace affskel::integration {
namespace {

using nlohmann::json;
using Entry = std::map<std::string, std::string>;

class OperatorsTest : public testing::Test {
 protected:
  OperatorsTest() { lab_.make_torus(2048); }

  /// Every line of a log, each of which must be an entry.
  std::vector<Entry> entries(const std::string& log) const {
    std::vector<Entry> all;
    std::istringstream lines(lab_.read(log));
    for (std::string line; std::getline(lines, line);) {
      all.push_back(tests::LogfmtParser(line).parse());
      for (const char* key : {"time", "level", "event"}) EXPECT_TRUE(all.back().contains(key)) << line;
    }
    return all;
  }

  std::string submit(const std::string& mesh) const {
    grpc::ClientContext context;
    v1::SubmitJobResponse response;
    const auto writer = lab_.stub().SubmitJob(&context, &response);
    v1::SubmitJobRequest request;
    v1::SubmitJobHeader& header = *request.mutable_header();
    header.mutable_params()->mutable_sampling()->set_spacing(1);
    header.set_mesh_sha256(wire::sha256_hex(mesh));
    header.set_mesh_bytes(mesh.size());
    writer->Write(request);
    request.set_data(mesh);
    writer->Write(request);
    writer->WritesDone();
    const grpc::Status status = writer->Finish();
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response.job().id();
  }

  /// The events of a job as the client prints them.
  std::vector<json> events(const std::string& job) const {
    const Output output = lab_.client({"--json", "log", job});
    EXPECT_EQ(output.exit_code, 0) << output.err;
    std::vector<json> all;
    std::istringstream lines(output.out);
    for (std::string line; std::getline(lines, line);) all.push_back(json::parse(line));
    return all;
  }

  std::map<std::string, tests::Exposed> scrape() const {
    return tests::read_exposition(tests::http_get(lab_.metrics_address(), "/metrics").body);
  }

  Output serve_metrics_on(const std::string& address) const {
    return lab_.run({AFFSKEL_SERVER_BINARY, "--data-dir", lab_.path("other"), "--metrics", address});
  }

  Lab lab_;
};

TEST_F(OperatorsTest, EveryLineOfARealRunParses) {
  std::string good, bad;
  {
    Process server = lab_.server({"--workers", "2", "--report-interval-ms", "100", "--log-level", "debug"});
    good = lab_.submit({"--points", "300000", "--name", "a \"name\" = \\ x"});
    lab_.follow_to_share(good, 0.1);
    v1::ServerInfo info;
    grpc::ClientContext context;
    ASSERT_TRUE(lab_.stub().GetServerInfo(&context, {}, &info).ok());
    kill(static_cast<pid_t>(info.workers(0).pid()), SIGKILL);
    // What a worker quotes of a file is anybody's text.  The command line would have refused it by itself.
    bad = submit("OFF\n3 1 0\n0 0 0\n1 0 0\n\"event=done\\ \x1b[31m 0\n3 0 1 2\n");
    EXPECT_EQ(lab_.follow_to_end(bad).error().code(), "BAD_INPUT");
    EXPECT_EQ(lab_.follow_to_end(good).state(), v1::JOB_STATE_DONE);
    server.send(SIGTERM);
    EXPECT_EQ(server.wait(), 0);
  }
  std::map<std::string, int> seen;
  const std::string owner = [&] {
    for (const Entry& entry : entries("server.log")) {
      if (entry.at("event") == "submitted") return entry.at("owner");
    }
    return std::string();
  }();
  EXPECT_NE(owner, "");
  for (const Entry& entry : entries("server.log")) {
    const std::string& event = entry.at("event");
    ++seen[event];
    // The server's own lines about a task; those of workers have the lease instead.
    if ((event == "leased" || event == "finished" || event == "lease_lost") && !entry.contains("lease") &&
        entry.contains("task")) {
      EXPECT_EQ(entry.at("owner"), owner);
      EXPECT_TRUE(entry.at("job") == good || entry.at("job") == bad);
      EXPECT_TRUE(entry.contains("worker") && entry.contains("kind"));
    }
  }
  for (const char* event : {"listening", "worker_started", "ready", "submitted", "leased", "prepared",
                            "finished", "eroded", "worker_ended", "done", "failed", "stopping", "stopped"}) {
    EXPECT_GT(seen[event], 0) << event;
  }
}

TEST_F(OperatorsTest, AJobsLogTellsItsLife) {
  const Process server = lab_.server({"--workers", "1"});
  const std::string id = lab_.submit({"--points", "5000"});
  ASSERT_EQ(lab_.follow_to_end(id).state(), v1::JOB_STATE_DONE);
  const std::vector<json> all = events(id);
  EXPECT_EQ(all.front().at("event"), "submitted");
  EXPECT_EQ(all.back().at("event"), "done");
  std::map<int, std::string> running;  // by task
  std::uint64_t before = 0;
  for (const json& event : all) {
    EXPECT_EQ(event.at("job"), id);
    EXPECT_GE(event.at("time_ms"), before);
    before = event.at("time_ms");
    const int task = event.at("task");
    if (event.at("event") == "leased") {
      EXPECT_TRUE(running.emplace(task, event.at("worker")).second) << "leased twice";
    }
    if (event.at("event") == "finished" || event.at("event") == "returned") {
      EXPECT_EQ(running[task], event.at("worker"));
      running.erase(task);
    }
  }
  EXPECT_TRUE(running.empty());
  EXPECT_FALSE(all.front().contains("givers"));
  const json& givers = all.back().at("givers");
  ASSERT_EQ(givers.size(), 1U) << givers;
  EXPECT_EQ(givers.at(0).at("directions"), 2048) << "the one worker gave them all";
  EXPECT_NE(lab_.client({"log", "@last"}).out.find("submitted  "), std::string::npos);
  EXPECT_EQ(lab_.client({"log", "000000"}).exit_code, 4);
}

TEST_F(OperatorsTest, MetricsAreToldWhereServerJsonSays) {
  const Process server = lab_.server({"--workers", "1", "--metrics", "127.0.0.1:0"});
  const std::string id = lab_.submit({"--points", "20000"});
  const v1::Job done = lab_.follow_to_end(id);
  ASSERT_EQ(done.state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(tests::http_get(lab_.metrics_address(), "/healthz").body, "ok\n");
  const auto seen = scrape();
  EXPECT_EQ(value_of(seen, "affskel_directions_total"), static_cast<double>(done.directions_total()));
  EXPECT_EQ(value_of(seen, "affskel_jobs", {{"state", "done"}}), 1);
  EXPECT_EQ(value_of(seen, "affskel_owner_mesh_bytes", {{"owner", done.owner()}}),
            static_cast<double>(done.mesh_bytes()));
}

TEST_F(OperatorsTest, AnAddressForMetricsThatCannotBeIsRefused) {
  const Process server = lab_.server({"--metrics", "127.0.0.1:0"});
  const std::map<std::string, std::string> refused = {{"0.0.0.0:0", "--insecure"},
                                                      {"unix:m.sock", "expected HOST:PORT"},
                                                      {"127.0.0.1", "no port"},
                                                      {lab_.metrics_address(), "in use"}};
  for (const auto& [address, why] : refused) {
    const Output output = serve_metrics_on(address);
    EXPECT_EQ(output.exit_code, 2) << address;
    EXPECT_NE(output.err.find(address), std::string::npos) << output.err;
    EXPECT_NE(output.err.find(why), std::string::npos) << output.err;
  }
}

}  // namespace
}  // namespace affskel::integration
