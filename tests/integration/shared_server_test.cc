// A server for several people, over TLS and with tokens.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "lab.h"
#include "tools/test_authority.h"

namespace affskel::integration {
namespace {

class SharedServerTest : public testing::Test {
 protected:
  SharedServerTest() : authority_(lab_.path(""), "authority") {
    authority_.sign("server");
    lab_.run({AFFSKEL_CLIENT_BINARY, "make", "torus", "--triangles", "512", "-o", lab_.path("m.off")});
  }

  /// Makes a token and keeps it in a file of its owner's name; returns it.
  std::string add_token(const std::string& owner, const std::string& role = "user") const {
    const std::string file = lab_.path(owner + ".token");
    const std::vector<std::string> command = {AFFSKEL_SERVER_BINARY,
                                              "token",
                                              "add",
                                              "--data-dir",
                                              lab_.path("data"),
                                              "--owner",
                                              owner,
                                              "--role",
                                              role,
                                              "-o",
                                              file};
    const Output made = lab_.run(command);
    EXPECT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(made.out, "") << "it is in its file alone";
    EXPECT_EQ(std::filesystem::status(file).permissions(),
              std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
    const std::string token = lab_.read(owner + ".token");
    EXPECT_NE(lab_.run(command).exit_code, 0) << "no token is written over";
    EXPECT_EQ(lab_.read(owner + ".token"), token);
    return token.substr(0, token.find('\n'));
  }

  /// Serves TLS on a port of loopback, beside the lab's own socket.
  Process start_server() {
    Process server = lab_.server({"--listen", "localhost:0", "--tls-cert", authority_.certificate("server"),
                                  "--tls-key", authority_.key("server")});
    const auto told = nlohmann::json::parse(lab_.read("data/server.json"));
    for (const std::string address : told["addresses"]) {
      if (address.rfind("unix:", 0) != 0) address_ = address;
    }
    return server;
  }

  std::vector<std::string> access_of(const std::string& owner) const {
    std::vector<std::string> options = {"--server", address_, "--tls-ca", authority_.file()};
    if (!owner.empty()) options.insert(options.end(), {"--token-file", lab_.path(owner + ".token")});
    return options;
  }
  Output client(const std::string& owner, const std::vector<std::string>& arguments) const {
    std::vector<std::string> words = {AFFSKEL_CLIENT_BINARY};
    const std::vector<std::string> access = access_of(owner);
    words.insert(words.end(), access.begin(), access.end());
    words.insert(words.end(), arguments.begin(), arguments.end());
    return lab_.run(words);
  }

  Lab lab_;
  tests::TestAuthority authority_;
  std::string address_;
};

TEST_F(SharedServerTest, WhoComesInTheClearIsToldOfTls) {
  const Process server = start_server();
  const Output refused = lab_.run({AFFSKEL_CLIENT_BINARY, "--server", address_, "list"});
  EXPECT_EQ(refused.exit_code, 5);
  EXPECT_NE(refused.err.find("--tls-ca"), std::string::npos) << refused.err;
}

TEST_F(SharedServerTest, WhoTrustsOthersIsToldInOneLine) {
  const Process server = start_server();
  const tests::TestAuthority other(lab_.path(""), "other");
  const Output refused =
      lab_.run({AFFSKEL_CLIENT_BINARY, "--quiet", "--server", address_, "--tls-ca", other.file(), "list"});
  EXPECT_EQ(refused.exit_code, 5);
  EXPECT_TRUE(refused.err.starts_with("error: cannot reach the server at ")) << refused.err;
  EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
}

TEST_F(SharedServerTest, PeopleAndWorkersComeByTlsAndTokens) {
  const std::string adas = add_token("ada");
  add_token("bob");
  const std::string clusters = add_token("cluster", "worker");
  const Process server = start_server();
  std::vector<std::string> words = {AFFSKEL_WORKER_BINARY};
  for (const std::string& word : access_of("cluster")) words.push_back(word);
  const Process worker(words, lab_.path("tls-worker.log"));
  const Output submitted =
      client("ada", {"submit", lab_.path("m.off"), "--points", "3000", "-o", lab_.path("out")});
  ASSERT_EQ(submitted.exit_code, 0) << submitted.err;
  const std::string id = submitted.out.substr(0, submitted.out.find('\n'));
  EXPECT_EQ(client("ada", {"status", "@last"}).exit_code, 0);
  const Output other = client("bob", {"status", id}),
               nobody = client("bob", {"status", std::string(32, 'a')});
  EXPECT_EQ(other.exit_code, 4);
  EXPECT_EQ(nobody.exit_code, 4);
  EXPECT_EQ(client("bob", {"list", "--json"}).out.find(id), std::string::npos);
  EXPECT_EQ(client("", {"list"}).exit_code, 7);
  EXPECT_EQ(client("cluster", {"list"}).exit_code, 7);
  // Secrets stand nowhere: not in logs, not on command lines.
  const std::string all = lab_.read("server.log") + lab_.read("tls-worker.log") + submitted.err + other.err;
  for (const std::string& token : {adas, clusters}) EXPECT_EQ(all.find(token.substr(8)), std::string::npos);
}

TEST_F(SharedServerTest, AWorkerWhoseTokenIsRevokedLeaves) {
  add_token("cluster", "worker");
  const Process server = start_server();
  std::vector<std::string> words = {AFFSKEL_WORKER_BINARY};
  for (const std::string& word : access_of("cluster")) words.push_back(word);
  Process worker(words, lab_.path("tls-worker.log"));
  const std::string id =
      lab_.client({"submit", lab_.path("m.off"), "--points", "100000", "--directions", "sphere:1000000"})
          .out.substr(0, 32);
  lab_.follow(id, [](const v1::Job& job) { return job.counters().reports() > 0; });
  EXPECT_EQ(
      lab_.run({AFFSKEL_SERVER_BINARY, "token", "revoke", "--data-dir", lab_.path("data"), "1"}).exit_code,
      0);
  EXPECT_EQ(worker.wait(), 7) << lab_.read("tls-worker.log");
  const v1::Job job = lab_.job(id);
  EXPECT_EQ(job.state(), v1::JOB_STATE_RUNNING) << "what it had goes to another";
  EXPECT_GT(job.directions_done(), 0u) << "what it had reported stays";
}

TEST_F(SharedServerTest, OtherMachinesAreNotServedInTheClear) {
  const auto serve = [&](std::vector<std::string> options) {
    options.insert(options.begin(),
                   {AFFSKEL_SERVER_BINARY, "--data-dir", lab_.path("data"), "--listen", "0.0.0.0:0"});
    return lab_.run(options);
  };
  const Output plain = serve({});
  EXPECT_EQ(plain.exit_code, 2);
  EXPECT_NE(plain.err.find("0.0.0.0:0"), std::string::npos);
  EXPECT_NE(plain.err.find("TLS"), std::string::npos);
  const Output no_token =
      serve({"--tls-cert", authority_.certificate("server"), "--tls-key", authority_.key("server")});
  EXPECT_EQ(no_token.exit_code, 2);
  EXPECT_NE(no_token.err.find("token add"), std::string::npos);
}

}  // namespace
}  // namespace affskel::integration
