#include "client/connection/embedded_server.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <chrono>
#include <sstream>
#include <thread>

#include "client/base/error.h"
#include "test_environment.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::client {
namespace {

TEST(EmbeddedPaths, FollowTheEnvironment) {
  EXPECT_EQ(embedded_paths(test_environment({{"HOME", "/home/u"}})).home, "/home/u/.local/share/affskel");
  EXPECT_EQ(embedded_paths(test_environment({{"HOME", "/home/u"}, {"XDG_DATA_HOME", "/d"}})).home,
            "/d/affskel");
  const EmbeddedPaths own =
      embedded_paths(test_environment({{"HOME", "/home/u"}, {"AFFSKEL_HOME", "/own/./place"}}));
  EXPECT_EQ(own.home, "/own/place");
  EXPECT_EQ(own.socket, "/own/place/server.sock");
  EXPECT_EQ(own.log, "/own/place/server.log");
  EXPECT_TRUE(own.socket_dir.empty());
  EXPECT_TRUE(embedded_paths(test_environment({{"AFFSKEL_HOME", "relative"}})).home.is_absolute());
  EXPECT_TRUE(embedded_paths(test_environment({{"HOME", "relative"}})).home.is_absolute());
}

TEST(EmbeddedPaths, DeepHomesGetAShortSocket) {
  const std::string fits(107 - std::string("/server.sock").size() - 1, 'a');
  EXPECT_EQ(embedded_paths(test_environment({{"AFFSKEL_HOME", "/" + fits}})).socket,
            "/" + fits + "/server.sock");
  const std::string deep = "/" + fits + "b";
  const EmbeddedPaths runtime =
      embedded_paths(test_environment({{"AFFSKEL_HOME", deep}, {"XDG_RUNTIME_DIR", "/run/user/7"}}));
  EXPECT_EQ(runtime.home, deep);
  EXPECT_EQ(runtime.socket_dir.parent_path(), "/run/user/7");
  EXPECT_EQ(runtime.socket.parent_path(), runtime.socket_dir);
  const EmbeddedPaths tmp = embedded_paths(test_environment({{"AFFSKEL_HOME", deep}}));
  EXPECT_EQ(tmp.socket_dir.parent_path(), "/tmp");
  EXPECT_LE(tmp.socket.native().size(), 107u);
  const EmbeddedPaths other = embedded_paths(test_environment({{"AFFSKEL_HOME", deep + "c"}}));
  EXPECT_NE(other.socket, tmp.socket);
}

TEST(MakePrivateDirectory, IsOursAlone) {
  const tests::TemporaryDirectory dir;
  make_private_directory(dir.path() / "a" / "b", true);
  struct stat info {};
  stat((dir.path() / "a" / "b").c_str(), &info);
  EXPECT_EQ(info.st_mode & 07777, 0700u);
  make_private_directory(dir.path() / "a" / "b", true);  // and stays so
}

TEST(MakePrivateDirectory, RefusesWhatOthersMayHavePrepared) {
  const tests::TemporaryDirectory dir;
  std::filesystem::create_directory(dir / "open");
  chmod((dir / "open").c_str(), 0770);
  EXPECT_THROW(make_private_directory(dir / "open", true), ClientError);
  EXPECT_NO_THROW(make_private_directory(dir / "open", false));
  std::filesystem::create_directory(dir / "real");
  chmod((dir / "real").c_str(), 0700);
  std::filesystem::create_directory_symlink("real", dir / "link");
  EXPECT_THROW(make_private_directory(dir / "link", true), ClientError);
  tests::write_file(dir / "file", "");
  EXPECT_THROW(make_private_directory(dir / "file", false), ClientError);
}

class EnsureEmbeddedServer : public ::testing::Test {
 protected:
  EnsureEmbeddedServer() {
    std::filesystem::create_directory(dir_ / "home");
    paths_ = embedded_paths(environment_);
    options_.program = FAKE_EMBEDDED_SERVER;
  }
  ~EnsureEmbeddedServer() override { end_server(); }

  // Whether nothing is left of it before long, not even a zombie.
  bool end_server() {
    const std::string pid = tests::read_file(dir_ / "home/pid");
    if (pid.empty()) return true;
    std::filesystem::remove(dir_ / "home/pid");
    kill(std::stoi(pid), SIGTERM);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (kill(std::stoi(pid), 0) == 0) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::yield();
    }
    return true;
  }

  tests::TemporaryDirectory dir_;
  Environment environment_ = test_environment({{"AFFSKEL_HOME", dir_ / "home"}});
  EmbeddedPaths paths_;
  EmbeddedOptions options_;
  Notices told_;
  const Listener listener_ = [this](const Notice& notice) { told_.push_back(notice); };
};

TEST_F(EnsureEmbeddedServer, StartsOneAndSaysSo) {
  const wire::Address address = ensure_embedded_server(paths_, options_, environment_, listener_);
  EXPECT_EQ(address.target(), "unix:" + paths_.socket.string());
  EXPECT_TRUE(wire::socket_answers(paths_.socket));
  ASSERT_EQ(told_.size(), 1U);
  EXPECT_EQ(told_[0].code, "SERVER_STARTED");
  EXPECT_NE(told_[0].message.find(paths_.home.string()), std::string::npos);
  EXPECT_EQ(tests::read_file(dir_ / "home/arguments"),
            "--data-dir\n" + paths_.home.string() + "\n--listen\nunix:" + paths_.socket.string() +
                "\n--workers\nauto\n--idle-exit\n60\nsession leader: 1\n");
}

TEST_F(EnsureEmbeddedServer, AttachesSilentlyToARunningOne) {
  ensure_embedded_server(paths_, options_, environment_, listener_);
  const std::string pid = tests::read_file(dir_ / "home/pid");
  told_.clear();
  ensure_embedded_server(paths_, options_, environment_, listener_);
  EXPECT_TRUE(told_.empty());
  EXPECT_EQ(tests::read_file(dir_ / "home/pid"), pid);
}

TEST_F(EnsureEmbeddedServer, LeavesNoZombieWhenItHasLeft) {
  ensure_embedded_server(paths_, options_, environment_, listener_);
  EXPECT_TRUE(end_server());
}

TEST_F(EnsureEmbeddedServer, TwoClientsAtOnceShareOne) {
  std::vector<std::thread> clients;
  std::atomic<int> good{0};
  for (int i = 0; i < 4; ++i) {
    clients.emplace_back([&] {
      ensure_embedded_server(paths_, options_, environment_, {});
      good += wire::socket_answers(paths_.socket) ? 1 : 0;
    });
  }
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(good, 4);
}

TEST_F(EnsureEmbeddedServer, TellsAFullDiskByItsExitCode) {
  tests::write_file(dir_ / "home/full", "");
  options_.grace = std::chrono::milliseconds(50);
  try {
    ensure_embedded_server(paths_, options_, environment_, listener_);
    FAIL();
  } catch (const ClientError& error) {
    EXPECT_EQ(error.exit_code(), ExitCode::kLimit);
  }
}

TEST_F(EnsureEmbeddedServer, ReportsTheLogOfAServerThatCannotStart) {
  tests::write_file(dir_ / "home/refuse", "");
  options_.grace = std::chrono::milliseconds(50);
  try {
    ensure_embedded_server(paths_, options_, environment_, listener_);
    FAIL();
  } catch (const ClientError& error) {
    EXPECT_EQ(error.exit_code(), ExitCode::kUnreachable);
    EXPECT_NE(std::string(error.what()).find("exited with code 3"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("it is refused"), std::string::npos) << error.what();
  }
}

TEST_F(EnsureEmbeddedServer, KeepsTheLogFromGrowingForEver) {
  tests::write_file(paths_.log, std::string(9 << 20, 'x'));
  ensure_embedded_server(paths_, options_, environment_, listener_);
  EXPECT_LT(std::filesystem::file_size(paths_.log), 1u << 20);
  EXPECT_EQ(std::filesystem::file_size(paths_.log.string() + ".1"), 9u << 20);
}

TEST_F(EnsureEmbeddedServer, ReportsAProgramThatCannotRun) {
  options_.program = dir_ / "nothing";
  EXPECT_THROW(ensure_embedded_server(paths_, options_, environment_, listener_), ClientError);
}

TEST(FindServerProgram, LooksInThePath) {
  const tests::TemporaryDirectory dir;
  try {
    find_server_program("/nowhere", test_environment({{"PATH", dir.path()}}));
    FAIL() << "found although it is nowhere";
  } catch (const ClientError& error) {
    EXPECT_EQ(error.exit_code(), ExitCode::kUnreachable);
  }
  tests::write_file(dir / "affskel-server", "");
  EXPECT_THROW(find_server_program("/nowhere", test_environment({{"PATH", dir.path()}})), ClientError)
      << "not executable";
  chmod((dir / "affskel-server").c_str(), 0700);
  const Environment found = test_environment({{"PATH", "relative:" + dir.path().string()}});
  EXPECT_EQ(find_server_program("/nowhere", found), dir / "affskel-server");
}

TEST(FindServerProgram, PrefersItsOwnDirectory) {
  const tests::TemporaryDirectory dir, other;
  for (const std::string& program : {dir / "affskel-server", other / "affskel-server"}) {
    tests::write_file(program, "");
    chmod(program.c_str(), 0700);
  }
  EXPECT_EQ(find_server_program(dir.path(), test_environment({{"PATH", other.path()}})),
            dir / "affskel-server");
}

}  // namespace
}  // namespace affskel::client
