// How the server leaves when its start waits, and what it does not wait for.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "lab.h"

namespace affskel::integration {
namespace {

/// Whether the process takes SIGTERM by a thread of its own: until then it has the usual effect.
bool blocks_sigterm(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string word; status >> word;) {
    if (word != "SigBlk:") continue;
    status >> word;
    return (std::stoull(word, nullptr, 16) >> (SIGTERM - 1) & 1) != 0;
  }
  return false;
}

class EndsTest : public testing::Test {
 protected:
  /// The server's end on that data directory; 124 when it does not come within a minute.
  Output start(const std::string& data, const std::vector<std::string>& options = {}) const {
    std::vector<std::string> words = {"/usr/bin/timeout", "--kill-after=1", "60",       AFFSKEL_SERVER_BINARY,
                                      "--data-dir",       lab_.path(data),  "--listen", lab_.address()};
    words.insert(words.end(), options.begin(), options.end());
    return lab_.run(words);
  }

  /// The path of a FIFO in a new directory.
  std::string make_fifo(const std::string& directory, const std::string& name) const {
    std::filesystem::create_directory(lab_.path(directory));
    std::string path = lab_.path(directory + "/" + name);
    if (mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error("no FIFO " + path);
    return path;
  }

  Lab lab_;
};

TEST_F(EndsTest, FifosInTheDataDirectoryAreRefused) {
  for (const std::string name : {"affskel.db", "affskel.db-wal", "affskel.db-shm", "server.lock"}) {
    const std::string path = make_fifo("with-" + name, name);
    const Output refused = start("with-" + name);
    EXPECT_EQ(refused.exit_code, 2) << name;
    EXPECT_NE(refused.err.find(name), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("a FIFO"), std::string::npos) << refused.err;
  }
}

TEST_F(EndsTest, FifosThatAreNamedAreRefused) {
  const std::string fifo = make_fifo("named", "fifo");
  const std::vector<std::vector<std::string>> ways = {{"--config", fifo},
                                                      {"--tls-cert", fifo, "--tls-key", fifo}};
  for (const auto& options : ways) {
    const Output refused = start("data", options);
    EXPECT_EQ(refused.exit_code, 2) << options[0];
    EXPECT_NE(refused.err.find(fifo), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("a FIFO"), std::string::npos) << refused.err;
  }
}

TEST_F(EndsTest, ASignalEndsAStartThatWaits) {
  std::filesystem::create_directory(lab_.path("data"));
  const int held = open(lab_.path("data/server.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  ASSERT_EQ(flock(held, LOCK_EX), 0);
  Process server({AFFSKEL_SERVER_BINARY, "--data-dir", lab_.path("data"), "--listen", lab_.address()},
                 lab_.path("server.log"));
  while (!blocks_sigterm(server.pid()) && server.running()) std::this_thread::yield();
  server.send(SIGTERM);
  EXPECT_EQ(server.wait(), 0);
  EXPECT_NE(lab_.read("server.log").find("event=stopping signal=15"), std::string::npos);
  close(held);
}

}  // namespace
}  // namespace affskel::integration
