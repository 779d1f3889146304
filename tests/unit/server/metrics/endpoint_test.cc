#include "metrics/endpoint.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>

#include "metrics/gauges.h"
#include "tools/exposition.h"
#include "tools/http_get.h"

namespace affskel::server {
namespace {

const wire::Address kAnyPort = wire::parse_address("127.0.0.1:0");

std::vector<prometheus::MetricFamily> one_gauge() {
  return Gauges().metric("affskel_jobs", "Jobs, by state").value(3, {{"state", "a\"b"}}).take();
}

EndpointSources well() {
  return {one_gauge, [] { return std::string(); }};
}

std::string error_of(const std::string& address, bool insecure = false) {
  try {
    require_local_metrics(wire::parse_address(address), insecure);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

TEST(EndpointTest, ServesMetricsInTheTextFormat) {
  const MetricsEndpoint endpoint(kAnyPort, well());
  EXPECT_GT(endpoint.address().port, 0);
  const tests::HttpAnswer answer = tests::http_get(endpoint.address().target(), "/metrics");
  EXPECT_EQ(answer.code, 200);
  EXPECT_NE(answer.head.find("Content-Type: text/plain; version=0.0.4"), std::string::npos) << answer.head;
  const auto metrics = tests::read_exposition(answer.body);
  EXPECT_EQ(metrics.size(), 1U);
  EXPECT_EQ(value_of(metrics, "affskel_jobs", {{"state", "a\"b"}}), 3);
}

TEST(EndpointTest, HealthIsOkOrSaysWhyNot) {
  std::atomic<bool> ill = false;
  const MetricsEndpoint endpoint(kAnyPort,
                                 {one_gauge, [&] { return std::string(ill ? "shutting down" : ""); }});
  const std::string address = endpoint.address().target();
  EXPECT_EQ(tests::http_get(address, "/healthz").code, 200);
  EXPECT_EQ(tests::http_get(address, "/healthz").body, "ok\n");
  ill = true;
  EXPECT_EQ(tests::http_get(address, "/healthz").code, 503);
  EXPECT_EQ(tests::http_get(address, "/healthz").body, "shutting down\n");
}

TEST(EndpointTest, WhatCannotBeToldIsAnErrorOfTheServer) {
  const auto broken = []() -> std::vector<prometheus::MetricFamily> { throw std::runtime_error("no disk"); };
  const MetricsEndpoint endpoint(kAnyPort,
                                 {broken, []() -> std::string { throw std::runtime_error("no disk"); }});
  for (const char* path : {"/metrics", "/healthz"}) {
    EXPECT_EQ(tests::http_get(endpoint.address().target(), path).code, 503) << path;
  }
}

TEST(EndpointTest, HasNothingElse) {
  const MetricsEndpoint endpoint(kAnyPort, well());
  for (const char* path :
       {"/", "/metrics/x", "/metricsx", "/CMakeLists.txt", "/../etc/passwd", "//etc/passwd"}) {
    EXPECT_GE(tests::http_get(endpoint.address().target(), path).code, 400) << path;
  }
}

TEST(EndpointTest, WhoIsSilentGivesWay) {
  EndpointOptions options;
  options.patience = std::chrono::milliseconds(100);
  const MetricsEndpoint endpoint(kAnyPort, well(), options);
  const std::string address = endpoint.address().target();
  // As many as there are threads, and more: some say nothing, some do not finish.
  std::vector<int> silent;
  for (unsigned i = 0; i < 3 * options.threads; ++i) {
    silent.push_back(tests::connect_tcp(address));
    if (i % 2 == 0) {
      ASSERT_EQ(send(silent.back(), "GET /met", 8, MSG_NOSIGNAL), 8);
    }
  }
  EXPECT_EQ(tests::http_get(address, "/metrics").code, 200);
  for (const int fd : silent) close(fd);
}

TEST(EndpointTest, AnAddressThatIsTakenIsNamed) {
  const MetricsEndpoint first(kAnyPort, well());
  try {
    const MetricsEndpoint second(first.address(), well());
    FAIL() << "two endpoints on one address";
  } catch (const std::runtime_error& error) {
    const std::string why = error.what();
    EXPECT_NE(why.find("cannot serve metrics on " + first.address().target() + ": "), std::string::npos)
        << why;
    EXPECT_NE(why.find("in use"), std::string::npos) << why;
  }
}

TEST(EndpointTest, OtherMachinesReachItOnlyWhenThatIsWanted) {
  for (const char* local : {"127.0.0.1:0", "localhost:9464", "[::1]:0", "127.8.8.8:1"}) {
    EXPECT_EQ(error_of(local), "") << local;
  }
  for (const char* open : {"0.0.0.0:0", "[::]:0", "lab.example.org:9464"}) {
    EXPECT_NE(error_of(open).find("--insecure"), std::string::npos) << open;
    EXPECT_EQ(error_of(open, true), "") << open;
  }
  EXPECT_NE(error_of("unix:/tmp/m.sock", true).find("expected HOST:PORT"), std::string::npos);
}

}  // namespace
}  // namespace affskel::server
