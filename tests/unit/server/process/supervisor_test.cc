#include "process/supervisor.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tools/temporary_directory.h"

namespace affskel::server {
namespace {

using std::chrono::milliseconds;

/// Calls tick until `condition`.
template <typename Condition>
void tick_until(Supervisor& supervisor, Condition condition) {
  while (!condition()) {
    supervisor.tick();
    std::this_thread::yield();
  }
}

SupervisorOptions shell(const std::string& script, unsigned workers) {
  SupervisorOptions options;
  options.workers = workers;
  options.command = {"/bin/sh", "-c", script};
  options.first_delay = milliseconds(1);
  options.last_delay = milliseconds(4);
  return options;
}

TEST(SupervisorTest, KeepsWorkersRunning) {
  std::vector<pid_t> started;
  std::vector<pid_t> ended;
  Supervisor supervisor(
      shell("exec sleep 1000", 2), [&](pid_t pid) { started.push_back(pid); },
      [&](pid_t pid) { ended.push_back(pid); });
  supervisor.tick();
  ASSERT_EQ(started.size(), 2U);
  EXPECT_EQ(supervisor.running(), 2U);
  kill(started[0], SIGKILL);
  tick_until(supervisor, [&] { return started.size() == 3; });
  EXPECT_EQ(ended, (std::vector<pid_t>{started[0]}));
  EXPECT_EQ(supervisor.running(), 2U);
  supervisor.terminate(std::chrono::seconds(30));
  EXPECT_EQ(supervisor.running(), 0U);
  EXPECT_EQ(std::set<pid_t>(ended.begin(), ended.end()), std::set<pid_t>(started.begin(), started.end()));
  supervisor.tick();
  EXPECT_EQ(started.size(), 3U) << "nothing is started after the end";
}

// An administrator distrusts it: another one on the same machine would compute as wrongly.
TEST(SupervisorTest, ADistrustedWorkerIsNotStartedAgain) {
  int started = 0, ended = 0;
  SupervisorOptions options = shell("exit 7", 1);
  options.is_distrusted = [](pid_t) { return true; };
  options.first_delay = options.last_delay = milliseconds(0);
  Supervisor supervisor(
      options, [&](pid_t) { ++started; }, [&](pid_t) { ++ended; });
  tick_until(supervisor, [&] { return ended == 1; });
  supervisor.tick();
  EXPECT_EQ(started, 1);
}

// Its token has expired, say, and its file gets another.
TEST(SupervisorTest, AWorkerThatMayNotWorkForAnotherReasonIsTriedAgain) {
  std::vector<pid_t> ended, asked;
  SupervisorOptions options = shell("exit 7", 1);
  options.is_distrusted = [&](pid_t pid) {
    asked.push_back(pid);
    return false;
  };
  Supervisor supervisor(
      options, [](pid_t) {}, [&](pid_t pid) { ended.push_back(pid); });
  tick_until(supervisor, [&] { return ended.size() == 3; });
  EXPECT_EQ(asked, ended);
}

TEST(SupervisorTest, ProgramThatCannotRunIsTriedAgain) {
  SupervisorOptions options = shell("", 1);
  options.command = {"/nonexistent/affskel-worker"};
  int ended = 0;
  Supervisor supervisor(
      options, [](pid_t) {}, [&](pid_t) { ++ended; });
  tick_until(supervisor, [&] { return ended == 3; });
}

TEST(SupervisorTest, DeafWorkersAreKilled) {
  const tests::TemporaryDirectory directory;
  const std::string ready = (directory.path() / "ready").string();
  int ended = 0;
  Supervisor supervisor(
      shell("trap '' TERM; : > '" + ready + "'; exec sleep 1000", 1), [](pid_t) {}, [&](pid_t) { ++ended; });
  tick_until(supervisor, [&] { return std::filesystem::exists(ready); });
  supervisor.terminate(milliseconds(20));
  EXPECT_EQ(ended, 1);
  EXPECT_EQ(supervisor.running(), 0U);
}

TEST(SupervisorTest, KillsAllForAProcessThatLeavesAtOnce) {
  const tests::TemporaryDirectory directory;
  const std::string ready = (directory.path() / "ready").string();
  int ended = 0;
  SupervisorOptions options = shell("trap '' TERM; : > '" + ready + "'; exec sleep 1000", 1);
  options.first_delay = options.last_delay = std::chrono::hours(1);
  Supervisor supervisor(
      options, [](pid_t) {}, [&](pid_t) { ++ended; });
  tick_until(supervisor, [&] { return std::filesystem::exists(ready); });
  supervisor.kill_all();
  tick_until(supervisor, [&] { return ended == 1; });
  EXPECT_EQ(supervisor.running(), 0U);
  supervisor.kill_all();  // no worker
}

TEST(SupervisorTest, NamesAMissingWorkerBinary) {
  EXPECT_THROW(find_worker_binary("/nonexistent/affskel-worker"), std::runtime_error);
  EXPECT_EQ(find_worker_binary("/bin/sh"), "/bin/sh");
}

}  // namespace
}  // namespace affskel::server
