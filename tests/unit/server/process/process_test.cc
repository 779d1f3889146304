#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>
#include <chrono>
#include <future>
#include <memory>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "process/data_dir.h"
#include "process/options.h"
#include "process/run.h"
#include "services/server.h"
#include "store_fixture.h"
#include "traffic/listen.h"

namespace affskel::server {
namespace {

/// @param said gets what goes to stderr.
ParsedOptions parse(std::vector<std::string> words, std::string* said = nullptr) {
  words.insert(words.begin(), "affskel-server");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const ParsedOptions parsed = parse_options(static_cast<int>(argv.size()), argv.data());
  testing::internal::GetCapturedStdout();
  const std::string err = testing::internal::GetCapturedStderr();
  if (said != nullptr) *said = err;
  return parsed;
}

TEST(OptionsTest, Defaults) {
  const ParsedOptions parsed = parse({"--data-dir", "here"});
  ASSERT_FALSE(parsed.exit_code);
  EXPECT_EQ(parsed.options.data_dir, "here");
  EXPECT_EQ(parsed.options.workers, 0U);
  EXPECT_FALSE(parsed.options.idle_exit_s);
}

TEST(OptionsTest, PolicyFromAFileAndTheCommandLine) {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "server.toml").string();
  std::ofstream(file) << "owner-order = \"round-robin\"\n"
                         "limit = [\"queued-jobs=100K\", \"stored-bytes=2T\"]\n"
                         "quota = [\"queued-jobs=2K\", \"ada:stored-bytes=500G\"]\n"
                         "retention = [\"results-age=90d\", \"grace=2d\"]\n";
  const ParsedOptions parsed = parse({"--data-dir", "here", "--config", file});
  ASSERT_FALSE(parsed.exit_code);
  EXPECT_EQ(parsed.options.owner_order, OwnerOrder::kRoundRobin);
  const Policy& policy = parsed.options.policy;
  EXPECT_EQ(policy.server.queued_jobs, 100'000);
  EXPECT_EQ(policy.server.stored_bytes, std::int64_t{2} << 40);
  EXPECT_EQ(policy.of("bob").quota.queued_jobs, 2000);
  EXPECT_EQ(policy.of("ada").quota.stored_bytes, std::int64_t{500} << 30);
  EXPECT_EQ(policy.of("ada").retention.results_age_ms, std::int64_t{90} * 24 * 3600 * 1000);
  EXPECT_EQ(policy.grace_ms, std::int64_t{2} * 24 * 3600 * 1000);
  EXPECT_EQ(parse({"--data-dir", "here", "--quota", "chords=1G"}).options.policy.of("x").quota.chords,
            1'000'000'000);
  EXPECT_EQ(parse({"--data-dir", "here", "--quota", "jobs=1"}).exit_code, 2);
  EXPECT_EQ(parse({"--data-dir", "here", "--owner-order", "fair"}).exit_code, 2);
}

TEST(OptionsTest, AMisspeltLineOfAFileIsToldWithItsPlace) {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "server.toml").string();
  const auto said_of = [&](const std::string& text) {
    std::ofstream(file) << text;
    std::string said;
    EXPECT_EQ(parse({"--data-dir", "here", "--config", file}, &said).exit_code, 2);
    return said;
  };
  const std::string option = said_of("workers = 2\n# nonsense\n nonsense = 1\n");
  EXPECT_NE(option.find(file + ": line 3: unknown option 'nonsense'"), std::string::npos) << option;
  const std::string section = said_of("workers = 2\n[ limits ]\nchords = 1\n");
  EXPECT_NE(section.find(file + ": line 2: unknown section 'limits'"), std::string::npos) << section;
}

TEST(OptionsTest, AllGiven) {
  const ParsedOptions parsed = parse({"--data-dir", "here", "--listen", "unix:a", "--listen", "127.0.0.1:0",
                                      "--workers", "3", "--worker-threads", "2", "--idle-exit", "1.5",
                                      "--lease-ms", "500", "--report-interval-ms", "100"});
  ASSERT_FALSE(parsed.exit_code);
  EXPECT_EQ(parsed.options.listen, (std::vector<std::string>{"unix:a", "127.0.0.1:0"}));
  EXPECT_EQ(parsed.options.workers, 3U);
  EXPECT_EQ(parsed.options.worker_threads, 2U);
  EXPECT_EQ(parsed.options.idle_exit_s, 1.5);
  EXPECT_EQ(parsed.options.lease_ms, 500);
}

TEST(OptionsTest, AutoIsAtLeastOneWorker) {
  EXPECT_GE(parse({"--data-dir", "here", "--workers", "auto"}).options.workers, 1U);
}

TEST(OptionsTest, UsageErrorsExitWithTwo) {
  EXPECT_EQ(parse({}).exit_code, 2);
  EXPECT_EQ(parse({"--data-dir", "d", "--workers", "many"}).exit_code, 2);
  EXPECT_EQ(parse({"--data-dir", "d", "--workers", "-1"}).exit_code, 2);
  EXPECT_EQ(parse({"--data-dir", "d", "--frobnicate"}).exit_code, 2);
  for (const char* never : {"nan", "inf", "-1", "soon"}) {
    EXPECT_EQ(parse({"--data-dir", "d", "--idle-exit", never}).exit_code, 2) << never;
  }
  EXPECT_EQ(parse({"--data-dir", "d", "--lease-ms", "100", "--report-interval-ms", "100"}).exit_code, 2);
  EXPECT_EQ(parse({"--help"}).exit_code, 0);
  EXPECT_EQ(parse({"--version"}).exit_code, 0);
}

TEST(OptionsTest, CommandsHaveOptionsOfTheirOwn) {
  EXPECT_EQ(parse({"--data-dir", "d"}).options.command, Command::kServe);
  const ParsedOptions check = parse({"check", "--data-dir", "d", "--json"});
  ASSERT_FALSE(check.exit_code);
  EXPECT_EQ(check.options.command, Command::kCheck);
  EXPECT_EQ(check.options.data_dir, "d");
  EXPECT_TRUE(check.options.json);
  const ParsedOptions backup = parse({"backup", "--data-dir", "d", "--output", "f", "--force"});
  ASSERT_FALSE(backup.exit_code);
  EXPECT_EQ(backup.options.command, Command::kBackup);
  EXPECT_EQ(backup.options.output, "f");
  EXPECT_TRUE(backup.options.force);
  EXPECT_FALSE(parse({"backup", "--data-dir", "d", "-o", "f"}).options.force);
  EXPECT_EQ(parse({"migrate", "--data-dir", "d"}).options.command, Command::kMigrate);
  const ParsedOptions trust = parse({"trust", "node7", "--data-dir", "d"});
  EXPECT_EQ(trust.options.command, Command::kTrust);
  EXPECT_EQ(trust.options.trusted, "node7");
  EXPECT_EQ(parse({"trust", "--data-dir", "d"}).exit_code, 2);
}

TEST(OptionsTest, MisusedCommandsExitWithTwo) {
  for (const char* command : {"check", "backup", "migrate"}) {
    EXPECT_EQ(parse({command}).exit_code, 2) << command;
    EXPECT_EQ(parse({command, "--help"}).exit_code, 0) << command;
  }
  EXPECT_EQ(parse({"--workers", "2", "check", "--data-dir", "d"}).exit_code, 2);
  EXPECT_EQ(parse({"--workers", "2", "migrate", "--data-dir", "d"}).exit_code, 2);
  EXPECT_EQ(parse({"--workers", "2", "backup", "--data-dir", "d", "-o", "f"}).exit_code, 2);
  EXPECT_EQ(parse({"backup", "--data-dir", "d"}).exit_code, 2);
  EXPECT_EQ(parse({"check", "--data-dir", "d", "--force"}).exit_code, 2);
  EXPECT_EQ(parse({"check", "migrate", "--data-dir", "d"}).exit_code, 2);
  EXPECT_EQ(parse({"check", "--data-dir", "d", "--workers", "2"}).exit_code, 2);
  // Ignored, it would be another directory than the one that was meant.
  EXPECT_EQ(parse({"--data-dir", "d", "check", "--data-dir", "e"}).exit_code, 2);
}

TEST(RunTest, DamagedDatabaseIsNoInternalError) {
  const TemporaryDirectory directory;
  Options options;
  options.data_dir = directory.path().string();
  std::ofstream(directory.path() / "affskel.db") << std::string(4096, 'x');
  EXPECT_EXIT(std::_Exit(run(options)), testing::ExitedWithCode(2), "affskel.db.*not a database");
}

TEST(RunTest, ARefusedStartMakesNothing) {
  const TemporaryDirectory directory;
  Options options;
  options.data_dir = (directory.path() / "new").string();
  options.listen = {"0.0.0.0:0"};
  EXPECT_EXIT(std::_Exit(run(options)), testing::ExitedWithCode(2), "0.0.0.0.*there is no TLS");
  options.tls_cert = options.tls_key = "lab.pem";
  EXPECT_EXIT(std::_Exit(run(options)), testing::ExitedWithCode(2), "0.0.0.0.*there is no token");
  EXPECT_FALSE(std::filesystem::exists(options.data_dir));
}

// As a directory that one may not enter.
TEST(RunTest, ADataDirectoryThatCannotBeLookedAtIsNamed) {
  const TemporaryDirectory directory;
  Options options;
  options.data_dir = (directory.path() / "loop").string();
  std::filesystem::create_symlink("loop", options.data_dir);
  options.insecure = true;
  EXPECT_EXIT(std::_Exit(run(options)), testing::ExitedWithCode(2), "data directory .*loop");
}

TEST(DataDirTest, IsHeldByOneServer) {
  const TemporaryDirectory directory;
  const std::string path = (directory.path() / "new" / "data").string();
  {
    const DataDir held(path);
    struct stat status {};
    ASSERT_EQ(stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0700U);
    try {
      const DataDir second(path, std::chrono::milliseconds(0));
      FAIL() << "two servers share one directory";
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(std::to_string(getpid())), std::string::npos) << error.what();
    }
  }
  EXPECT_NO_THROW(DataDir again(path));
}

TEST(DataDirTest, TellsItsHolder) {
  const TemporaryDirectory directory;
  const std::string path = directory.path().string();
  EXPECT_EQ(data_dir_holder(path), std::nullopt);
  EXPECT_TRUE(std::filesystem::is_empty(path)) << "asking changes nothing";
  {
    const DataDir held(path);
    EXPECT_EQ(data_dir_holder(path), "pid " + std::to_string(getpid()));
    EXPECT_THROW(DataDir(path, std::chrono::milliseconds(0)), DataDirInUse);
  }
  EXPECT_EQ(data_dir_holder(path), std::nullopt);
  const int asking = open((path + "/server.lock").c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(flock(asking, LOCK_SH), 0);
  EXPECT_EQ(data_dir_holder(path), std::nullopt) << "another one who asks is no server";
  close(asking);
  EXPECT_NO_THROW(DataDir(path, std::chrono::milliseconds(0))) << "whoever asks holds nothing";
}

// As when a client starts a private server while the idle one is leaving.
TEST(DataDirTest, WaitsForAServerThatLeaves) {
  const TemporaryDirectory directory;
  auto leaving = std::make_unique<DataDir>(directory.path().string());
  std::future<void> next = std::async(
      std::launch::async, [&] { const DataDir held(directory.path().string(), std::chrono::minutes(1)); });
  leaving.reset();
  EXPECT_NO_THROW(next.get());
}

TEST(DataDirTest, NoticesThatItIsGone) {
  const TemporaryDirectory directory;
  const std::filesystem::path path = directory.path() / "data";
  const DataDir held(path.string());
  EXPECT_FALSE(held.lost());
  std::filesystem::rename(path, directory.path() / "moved");
  EXPECT_TRUE(held.lost());
  const DataDir successor(path.string());
  EXPECT_TRUE(held.lost()) << "another directory of that name is not the one that was held";
  EXPECT_FALSE(successor.lost());
}

TEST(DataDirTest, RefusesAFile) {
  const TemporaryDirectory directory;
  const std::string path = (directory.path() / "file").string();
  std::ofstream(path) << "x";
  EXPECT_THROW(DataDir held(path), std::runtime_error);
}

TEST(DataDirTest, PublishesItself) {
  const TemporaryDirectory directory;
  const DataDir held(directory.path().string());
  held.publish({"unix:a", "127.0.0.1:5"}, "127.0.0.1:6", 42);
  std::ifstream in(directory.path() / "server.json");
  const nlohmann::json json = nlohmann::json::parse(in);
  EXPECT_EQ(json["pid"], getpid());
  EXPECT_EQ(json["addresses"], (std::vector<std::string>{"unix:a", "127.0.0.1:5"}));
  EXPECT_EQ(json["started_ms"], 42);
  held.withdraw();
  EXPECT_FALSE(std::filesystem::exists(directory.path() / "server.json"));
}

TEST(ListenTest, WhatOtherMachinesReachNeedsTlsAndTokens) {
  const auto refused = [](const char* address, const Protection& protection) {
    try {
      require_protection({wire::parse_address(address)}, protection);
      return false;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(address), std::string::npos);
      return true;
    }
  };
  for (const char* local : {"127.0.0.1:1", "localhost:1", "[::1]:1", "unix:/tmp/s"}) {
    EXPECT_FALSE(refused(local, {false, false, false})) << local;
  }
  for (const char* far : {"0.0.0.0:1", "[::]:1", "192.0.2.1:1", "lab.example.org:1"}) {
    EXPECT_TRUE(refused(far, {false, false, false})) << far;
    EXPECT_TRUE(refused(far, {true, false, false})) << far;
    EXPECT_TRUE(refused(far, {false, true, false})) << far;
    EXPECT_FALSE(refused(far, {true, true, false})) << far;
    EXPECT_FALSE(refused(far, {false, false, true})) << far;
  }
}

/// A listening Unix socket; stays behind as a file when closed.
class RawSocket {
 public:
  explicit RawSocket(const std::string& path) : fd_(socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::memcpy(name.sun_path, path.data(), path.size());
    EXPECT_EQ(bind(fd_, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
    EXPECT_EQ(::listen(fd_, 5), 0);
  }
  ~RawSocket() { close(fd_); }

 private:
  int fd_;
};

TEST(ListenTest, ReplacesOnlyStaleSockets) {
  const TemporaryDirectory directory;
  const std::string path = (directory.path() / "s").string();
  const std::vector<wire::Address> addresses = {wire::parse_address("unix:" + path)};
  {
    const RawSocket alive(path);
    EXPECT_THROW(prepare_addresses(addresses), std::runtime_error);
    EXPECT_TRUE(std::filesystem::exists(path));
  }
  prepare_addresses(addresses);
  EXPECT_FALSE(std::filesystem::exists(path));
  std::ofstream(path) << "not a socket";
  EXPECT_THROW(prepare_addresses(addresses), std::runtime_error);
  EXPECT_TRUE(std::filesystem::exists(path));
}

TEST(ListenTest, ServerListensPrivatelyAndTellsItsPort) {
  const TemporaryDirectory directory;
  ServerOptions options;
  options.data_dir = directory.path().string();
  options.listen = {wire::parse_address("unix:" + options.data_dir + "/s"),
                    wire::parse_address("127.0.0.1:0")};
  {
    const Server server(options);
    struct stat status {};
    ASSERT_EQ(stat((options.data_dir + "/s").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0600U);
    ASSERT_EQ(server.addresses().size(), 2U);
    EXPECT_GT(server.addresses()[1].port, 0);
    ServerOptions second = options;
    second.listen = {server.addresses()[1]};
    EXPECT_THROW(Server rival(second), std::runtime_error) << "the port is taken";
  }
  EXPECT_FALSE(std::filesystem::exists(options.data_dir + "/s"));
}

}  // namespace
}  // namespace affskel::server
