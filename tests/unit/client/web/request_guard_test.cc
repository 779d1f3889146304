#include "client/web/request_guard.h"

#include <gtest/gtest.h>

namespace affskel::client {
namespace {

http::Request request(const std::string& method, const std::string& path,
                      std::vector<std::pair<std::string, std::string>> headers) {
  http::Request made;
  made.method = method;
  made.path = path;
  made.headers = std::move(headers);
  return made;
}

int refusal(const http::Request& made, const HostRule& rule = {}) {
  const auto refused = refuse_foreign(made, rule);
  return refused ? refused->status : 0;
}

TEST(HostName, PartsThePort) {
  EXPECT_EQ(host_name("LocalHost:80"), "localhost");
  EXPECT_EQ(host_name("lab"), "lab");
  EXPECT_EQ(host_name("[::1]:8080"), "::1");
  for (const char* malformed : {"", ":80", "[::1", "a:", "a:b", "a:80:90", "[::1]x"})
    EXPECT_EQ(host_name(malformed), std::nullopt) << malformed;
}

TEST(RequestGuard, TakesOnlyItsOwnNames) {
  for (const char* own : {"localhost:1", "127.0.0.1:8080", "127.3.2.1", "[::1]:80"})
    EXPECT_EQ(refusal(request("GET", "/api/jobs", {{"host", own}})), 0) << own;
  for (const char* other :
       {"evil.example:80", "127.0.0.1.evil.example", "localhost.evil.example", "10.0.0.1", ""})
    EXPECT_EQ(refusal(request("GET", "/", {{"host", other}})), 421) << other;
  EXPECT_EQ(refusal(request("GET", "/", {})), 421);
  EXPECT_EQ(refusal(request("GET", "/", {{"host", "localhost"}, {"host", "localhost"}})), 421);
}

TEST(RequestGuard, OffLoopbackTheCertificateNamesTheHosts) {
  HostRule rule;
  rule.loopback = false;
  rule.certified = [](const std::string& name) { return name == "lab.example"; };
  EXPECT_EQ(refusal(request("GET", "/", {{"host", "lab.example:8443"}}), rule), 0);
  EXPECT_EQ(refusal(request("GET", "/", {{"host", "localhost"}}), rule), 421);
}

TEST(RequestGuard, RefusesOtherSites) {
  const auto with_site = [](const char* method, const char* path, const char* site) {
    return request(method, path,
                   {{"host", "localhost"}, {"origin", "http://localhost"}, {"sec-fetch-site", site}});
  };
  EXPECT_EQ(refusal(with_site("POST", "/api/jobs", "same-origin")), 0);
  EXPECT_EQ(refusal(with_site("GET", "/results/1", "none")), 0);
  for (const char* site : {"same-site", "cross-site", "sideways"}) {
    EXPECT_EQ(refusal(with_site("GET", "/api/jobs", site)), 403) << site;
    EXPECT_EQ(refusal(with_site("POST", "/api/jobs", site)), 403) << site;
    EXPECT_EQ(refusal(with_site("GET", "/", site)), 403) << site << " as an image, say";
  }
  EXPECT_EQ(refusal(with_site("POST", "/api/jobs", "none")), 403);
}

TEST(RequestGuard, OtherSitesMayLinkToThePageAlone) {
  for (const auto& [path, status] :
       {std::pair("/", 0), std::pair("/api/jobs", 403), std::pair("/results/1", 403)}) {
    const auto link = request("GET", path,
                              {{"host", "localhost"},
                               {"sec-fetch-site", "cross-site"},
                               {"sec-fetch-mode", "navigate"},
                               {"sec-fetch-dest", "document"}});
    EXPECT_EQ(refusal(link), status) << path;
  }
  EXPECT_EQ(refusal(request("GET", "/",
                            {{"host", "localhost"},
                             {"sec-fetch-site", "cross-site"},
                             {"sec-fetch-mode", "navigate"},
                             {"sec-fetch-dest", "iframe"}})),
            403);
}

TEST(RequestGuard, WhatChangesSomethingNamesThisOrigin) {
  const auto from = [](const char* method, std::vector<std::pair<std::string, std::string>> origins,
                       bool secure) {
    origins.emplace_back("host", "localhost:8080");
    http::Request made = request(method, "/api/jobs", std::move(origins));
    made.secure = secure;
    return refusal(made);
  };
  for (const char* method : {"POST", "DELETE"}) {
    EXPECT_EQ(from(method, {{"origin", "http://localhost:8080"}}, false), 0);
    EXPECT_EQ(from(method, {{"origin", "https://localhost:8080"}}, true), 0);
    EXPECT_EQ(from(method, {{"origin", "http://localhost:8080"}}, true), 403) << "another scheme";
    EXPECT_EQ(from(method, {{"origin", "http://localhost:8081"}}, false), 403) << "another port";
    EXPECT_EQ(from(method, {{"origin", "null"}}, false), 403);
    EXPECT_EQ(from(method, {}, false), 403);
    EXPECT_EQ(from(method, {{"origin", "http://localhost:8080"}, {"origin", "http://evil"}}, false), 403);
  }
  EXPECT_EQ(from("GET", {}, false), 0);
  EXPECT_EQ(from("GET", {{"origin", "http://evil.example"}}, false), 403);
}

}  // namespace
}  // namespace affskel::client
