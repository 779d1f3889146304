#include "link/server_link.h"

#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "link_fixture.h"
#include "wire/limits.h"

namespace affskel::worker {
namespace {

/// Sets the proxy of the environment, and no exceptions from it, while it lives.
class ProxyEnvironment {
 public:
  explicit ProxyEnvironment(const char* proxy) {
    for (const char* name : {"http_proxy", "grpc_proxy", "https_proxy", "no_proxy", "no_grpc_proxy"}) {
      const char* value = std::getenv(name);
      before_.emplace_back(name, value == nullptr ? std::nullopt : std::optional<std::string>(value));
      unsetenv(name);
    }
    setenv("http_proxy", proxy, 1);
  }
  ProxyEnvironment(const ProxyEnvironment&) = delete;
  ProxyEnvironment& operator=(const ProxyEnvironment&) = delete;
  ~ProxyEnvironment() {
    for (const auto& [name, value] : before_) {
      value ? setenv(name, value->c_str(), 1) : unsetenv(name);
    }
  }

 private:
  std::vector<std::pair<const char*, std::optional<std::string>>> before_;
};

TEST_F(LinkTest, TriesAgainWhileTheServerIsAway) {
  server_.fail_next("RenewLease", {grpc::StatusCode::UNAVAILABLE, "away"}, 3);
  server_.fail_next("RenewLease", {grpc::StatusCode::RESOURCE_EXHAUSTED, "disk full"}, 1);
  server_.fail_next("RenewLease", {grpc::StatusCode::CANCELLED, "a server that closes says so, too"}, 2);
  link().renew("t");
  EXPECT_EQ(server_.calls("RenewLease"), 7);
}

TEST_F(LinkTest, ReachesAServerOfThisMachineWithoutTheProxyOfTheEnvironment) {
  const ProxyEnvironment nobody_there("http://127.0.0.1:9");
  ServerLink({server_.tcp_address(), std::chrono::seconds(1)}, stop_.get_token()).renew("t");
  EXPECT_EQ(server_.calls("RenewLease"), 1);
}

TEST_F(LinkTest, SaysOnceThatTheServerIsAway) {
  const LogCapture capture;
  server_.fail_next("RenewLease", {grpc::StatusCode::UNAVAILABLE, "away"}, 3);
  ServerLink to_server = link();
  to_server.renew("t");
  to_server.renew("t");
  const std::string log = capture.text();
  const std::size_t first = log.find("event=server_away ");
  EXPECT_NE(first, std::string::npos) << log;
  EXPECT_EQ(log.find("event=server_away ", first + 1), std::string::npos) << log;
}

// More than gRPC takes by itself.
TEST_F(LinkTest, TakesAsManyBoundsAsItSays) {
  server_.on_report([](const v1::ReportErosionHeader& header) {
    v1::ReportResponse response;
    const std::size_t points = header.bounds_bytes() / 5;  // step and bound
    v1::ErosionBounds* bounds = response.add_bounds();
    bounds->mutable_step()->Resize(static_cast<int>(points), 1);
    bounds->mutable_bound()->Resize(static_cast<int>(points), 1);
    return response;
  });
  const v1::ReportResponse response = link().report({}, {});
  EXPECT_EQ(response.bounds(0).step_size(), static_cast<int>(wire::kMaxBoundsBytes / 5));
}

TEST_F(LinkTest, GivesUpWhenTheLeaseIsLostOrTheServerStaysAway) {
  server_.fail_next("RenewLease", {grpc::StatusCode::ABORTED, "fenced"});
  EXPECT_THROW(link().renew("t"), LeaseLost);
  EXPECT_THROW(
      ServerLink({"unix:/nowhere/server.sock", std::chrono::seconds(0)}, stop_.get_token()).renew("t"),
      ServerGone);
}

TEST_F(LinkTest, AsksForWorkAgainWhenTheServersDiskCannotBeRead) {
  for (const auto code :
       {grpc::StatusCode::DATA_LOSS, grpc::StatusCode::ABORTED, grpc::StatusCode::NOT_FOUND}) {
    server_.fail_next("LeaseTask", {code, "its disk cannot be read"}, 2);
    const int before = server_.calls("LeaseTask");
    EXPECT_FALSE(link().lease({})) << "there is no work";
    EXPECT_EQ(server_.calls("LeaseTask"), before + 3);
  }
}

TEST_F(LinkTest, LargeCallsMayTakeLonger) {
  link().complete({}, "small");
  link().complete({}, std::string(10 << 20, 'x'));
  const std::vector<FakeServer::Completion> completions = server_.completions();
  EXPECT_LT(completions[0].time_left, std::chrono::minutes(3))
      << "gRPC rounds up what it sends of a deadline";
  EXPECT_GT(completions[1].time_left, std::chrono::hours(2)) << "at 1 KiB a second";
}

TEST_F(LinkTest, FetchesAgainWhatArrivedDamaged) {
  const std::string mesh = sample_mesh();
  server_.set_input(v1::ARTIFACT_KIND_MESH, mesh);
  server_.damage_next_fetch();
  EXPECT_TRUE(link().fetch("t", v1::ARTIFACT_KIND_MESH) == mesh);
  EXPECT_EQ(server_.calls("FetchInput1"), 2);
}

}  // namespace
}  // namespace affskel::worker
