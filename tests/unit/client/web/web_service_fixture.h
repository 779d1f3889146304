#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "client/web/web_service.h"
#include "client_fixture.h"
#include "test_environment.h"
#include "tools/files.h"

namespace affskel::client {

using nlohmann::json;

/// An answer, its file read.
struct Answer {
  int status = 0;
  std::vector<std::pair<std::string, std::string>> headers;
  std::string body;

  std::string header(const std::string& name) const {
    for (const auto& [key, value] : headers) {
      if (key == name) return value;
    }
    return "";
  }
  json object() const { return json::parse(body); }
  std::string error() const { return object()["error"]["message"]; }
};

/// The service before a server in this process that holds one done job, without a network between them.
class WebServiceTest : public ClientTest {
 protected:
  WebServiceTest() {
    service_.caller = caller("me", v1::ROLE_ADMIN);
    serve(true);
  }

  static v1::Caller caller(const std::string& owner, v1::Role role) {
    v1::Caller made;
    made.set_owner(owner);
    made.set_role(role);
    return made;
  }

  void serve(bool personal, std::chrono::nanoseconds repair_limit = {}) {
    RetryPolicy retry;
    retry.first_pause = std::chrono::milliseconds(1);
    retry.patience = std::chrono::milliseconds(200);
    WebOptions options;
    options.port = 8080;
    options.personal = personal;
    options.repair_limit = repair_limit;
    web_ = std::make_unique<WebService>(
        Backend(test_environment({{"HOME", dir_.path()}}), server_.address(), {}, retry), options);
  }

  // As a browser sends it from the page.
  http::Request request_of(const std::string& method, const std::string& target) const {
    const auto parsed = http::parse_target(target);
    http::Request request;
    request.method = method;
    request.path = parsed->path;
    request.query = parsed->query;
    request.headers = {{"host", "localhost:8080"}, {"sec-fetch-site", "same-origin"}};
    if (method != "GET") request.headers.emplace_back("origin", origin_);
    if (!cookie_.empty()) request.headers.emplace_back("cookie", cookie_);
    request.gone = gone_.get_token();
    return request;
  }

  Answer ask(const std::string& method, const std::string& target, const std::string& body = "") {
    http::Request request = request_of(method, target);
    auto admitted = web_->admit(request);
    if (auto* refusal = std::get_if<http::Response>(&admitted)) return read(*refusal);
    http::Reception& reception = std::get<http::Reception>(admitted);
    if (body.size() > reception.max_bytes) return {413, {}, ""};
    if (reception.file.empty()) {
      request.body = body;
    } else {
      tests::write_file(reception.file, body);
    }
    return read(reception.respond(request));
  }

  // By a token, or by a new key.
  void sign_in(const std::string& token = "") {
    const json asked = token.empty() ? json({{"key", web_->new_key()}}) : json({{"token", token}});
    const Answer answer = ask("POST", "/api/session", asked.dump());
    ASSERT_EQ(answer.status, 200) << answer.body;
    const std::string cookie = answer.header("Set-Cookie");
    cookie_ = cookie.substr(0, cookie.find(';'));
  }

  // Makes a result and fetches it.
  Answer made(const json& asked) {
    const Answer answer = ask("POST", "/api/jobs/" + service_.job.id() + "/results", asked.dump());
    if (answer.status != 201) return answer;
    return ask("GET", answer.object()["href"]);
  }

  json uploaded(const std::string& name, const std::string& bytes) {
    const Answer answer = ask("POST", "/api/meshes?name=" + name, bytes);
    EXPECT_EQ(answer.status, 200) << answer.body;
    return answer.object();
  }

  std::unique_ptr<WebService> web_;
  std::stop_source gone_;  // of all requests' peers
  std::string cookie_, origin_ = "http://localhost:8080";

 private:
  static Answer read(const http::Response& response) {
    return {response.status, response.headers,
            response.file.empty() ? response.body : tests::read_file(response.file)};
  }
};

}  // namespace affskel::client
