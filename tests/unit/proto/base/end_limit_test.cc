#include "base/end_limit.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <condition_variable>
#include <mutex>
#include <string>

#include "base/stop_signals.h"

namespace affskel::base {
namespace {

using namespace std::chrono_literals;

/// How a child ends that runs `body`, and what it writes to stderr.
struct ChildEnd {
  int status = 0;
  std::string text;
};

template <class Body>
ChildEnd run_child(Body body) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // one that hangs ends with the test
    dup2(ends[1], STDERR_FILENO);
    close(ends[0]);
    close(ends[1]);
    body();
    _exit(0);
  }
  close(ends[1]);
  ChildEnd end;
  std::array<char, 256> bytes{};
  for (ssize_t size = 0; (size = read(ends[0], bytes.data(), bytes.size())) > 0;)
    end.text.append(bytes.data(), static_cast<std::size_t>(size));
  close(ends[0]);
  waitpid(child, &end.status, 0);
  return end;
}

void prepare(void (*before)() noexcept = nullptr) {
  set_end_limit({.limit = 1s, .entry = "event=stuck", .exit_code = 71, .before = before});
}

/// As a server waits for what gRPC lost.
[[noreturn]] void hang() {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  for (;;) std::condition_variable().wait(lock);
}

/// From now on there is no new thread, and no new memory.
void take_everything() {
  const rlimit nothing{0, 0};
  setrlimit(RLIMIT_AS, &nothing);
  setrlimit(RLIMIT_NPROC, &nothing);
  setrlimit(RLIMIT_SIGPENDING, &nothing);
}

TEST(EndLimitTest, EndsWhatHangsWithoutMemoryOrThreads) {
  const ChildEnd end = run_child([] {
    prepare();
    take_everything();
    limit_end();
    hang();
  });
  ASSERT_TRUE(WIFEXITED(end.status)) << end.status;
  EXPECT_EQ(WEXITSTATUS(end.status), 71);
  EXPECT_EQ(end.text.substr(end.text.find(" level")), " level=critical event=stuck\n");
  EXPECT_EQ(end.text.substr(0, 7), "time=20") << end.text;
  EXPECT_EQ(end.text.find('Z'), std::string("time=2026-11-22T22:00:00.000").size()) << end.text;
}

TEST(EndLimitTest, CallsWhatIsToBeDoneBefore) {
  const ChildEnd end = run_child([] {
    prepare([]() noexcept { _exit(5); });
    limit_end();
    hang();
  });
  EXPECT_EQ(WEXITSTATUS(end.status), 5);
}

TEST(EndLimitTest, IsNotPutOffBySecondCalls) {
  const ChildEnd end = run_child([] {
    prepare();
    for (;;) limit_end();
  });
  EXPECT_EQ(WEXITSTATUS(end.status), 71);
}

TEST(EndLimitTest, IsTakenOfABlockedSignal) {
  const ChildEnd end = run_child([] {
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, nullptr);
    prepare();
    limit_end();
    hang();
  });
  EXPECT_EQ(WEXITSTATUS(end.status), 71);
}

TEST(EndLimitTest, LeavesThoughNobodyReadsItsLog) {
  const ChildEnd end = run_child([] {
    std::array<int, 2> full{};
    if (pipe2(full.data(), O_NONBLOCK) != 0) _exit(1);
    for (const char byte = 'x'; write(full[1], &byte, 1) == 1;) {
    }
    fcntl(full[1], F_SETFL, 0);
    dup2(full[1], STDERR_FILENO);
    leave_at_once("info", "event=stopping", 3);
  });
  EXPECT_EQ(WEXITSTATUS(end.status), 3);
}

TEST(EndLimitTest, DoesNothingWhereNoLimitIsSet) {
  EXPECT_EQ(run_child([] { limit_end(); }).status, 0);
}

TEST(StopSignalsTest, LimitTheEndThoughTheMainThreadHangs) {
  const ChildEnd end = run_child([] {
    prepare();
    const StopSignals signals([](int) {});
    take_everything();
    kill(getpid(), SIGTERM);
    hang();
  });
  ASSERT_TRUE(WIFEXITED(end.status)) << end.status;
  EXPECT_EQ(WEXITSTATUS(end.status), 71);
}

TEST(StopSignalsTest, TellEachWithItsNumber) {
  const ChildEnd end = run_child([] {
    const StopSignals signals([](int number) { _exit(number); });
    kill(getpid(), SIGINT);
    hang();
  });
  EXPECT_EQ(WEXITSTATUS(end.status), SIGINT);
}

}  // namespace
}  // namespace affskel::base
