#include "metrics/endpoint.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <future>

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

TEST(EndpointTest, AnswersBesideUnfinishedRequests) {
  EndpointOptions options;
  options.patience = std::chrono::hours(1);
  const MetricsEndpoint endpoint(kAnyPort, well(), options);
  const std::string address = endpoint.address().target();
  // Twice as many as there are places: some say nothing, some do not finish, some do not read.
  std::string unread;
  for (int i = 0; i < 1000; ++i) unread += "GET /metrics HTTP/1.1\r\n\r\n";
  const std::vector<std::string> beginnings = {"", "GET /met", "GET /metrics HTTP/1.1\r\nX: ", unread};
  std::vector<int> others;
  for (std::size_t i = 0; i < 2 * options.connections; ++i) {
    others.push_back(tests::connect_tcp(address));
    const std::string& text = beginnings[i % beginnings.size()];
    send(others.back(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    EXPECT_EQ(tests::http_get(address, "/metrics").code, 200);
    EXPECT_EQ(tests::http_get(address, "/healthz").code, 200);
  }
  for (const int fd : others) close(fd);
}

TEST(EndpointTest, HealthDoesNotWaitForMetrics) {
  std::promise<void> begun, open;
  const auto slow = [&] {
    begun.set_value();
    open.get_future().wait();
    return one_gauge();
  };
  const MetricsEndpoint endpoint(kAnyPort, {slow, [] { return std::string(); }});
  const std::string address = endpoint.address().target();
  auto metrics = std::async(std::launch::async, [&] { return tests::http_get(address, "/metrics").code; });
  begun.get_future().wait();
  EXPECT_EQ(tests::http_get(address, "/healthz").code, 200);
  open.set_value();
  EXPECT_EQ(metrics.get(), 200);
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
