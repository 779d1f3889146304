#include "client/cli/interrupt.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>

#include "base/atomic_file.h"
#include "client/base/error.h"
#include "tools/temporary_directory.h"

namespace affskel::client {
namespace {

void limit_file_size(rlim_t bytes) {
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_FSIZE, &limit);
}

// Each runs in a process of its own.
TEST(InterruptDeathTest, TellsThatTheJobGoesOn) {
  EXPECT_EXIT(
      {
        install_interrupt_handlers();
        set_interrupt_message("job 7 goes on\n");
        raise(SIGINT);
      },
      ::testing::ExitedWithCode(130), "job 7 goes on");
}

TEST(InterruptDeathTest, RemovesTheUnfinishedFile) {
  const tests::TemporaryDirectory dir;
  EXPECT_EXIT(
      {
        install_interrupt_handlers();
        base::AtomicFile file(dir / "out.csv");
        file.write(std::string(3 << 20, 'x'));
        if (dir.names().size() != 1) _exit(1);
        raise(SIGTERM);
      },
      ::testing::ExitedWithCode(143), "");
  EXPECT_TRUE(dir.names().empty());
}

// 0 when a base::AtomicFile into a pipe without a reader fails with a message about it.
[[noreturn]] void write_to_nobody() {
  install_interrupt_handlers();
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) _exit(3);
  close(ends[0]);
  dup2(ends[1], STDOUT_FILENO);
  try {
    base::AtomicFile file("-");
    file.write("x");
    file.commit();
  } catch (const base::FileError& failure) {
    const ClientError error = error_from_file(failure);
    const bool told = error.for_people() == "standard output: cannot write: Broken pipe";
    _exit(told && error.exit_code() == ExitCode::kClosedPipe ? 0 : 1);
  }
  _exit(2);
}

TEST(InterruptDeathTest, APipeThatNobodyReadsIsAnErrorNotADeath) {
  EXPECT_EXIT(write_to_nobody(), ::testing::ExitedWithCode(0), "");
}

TEST(InterruptDeathTest, RemovesEveryUnfinishedFile) {
  const tests::TemporaryDirectory dir;
  EXPECT_EXIT(
      {
        install_interrupt_handlers();
        base::AtomicFile first(dir / "a.csv");
        base::AtomicFile second(dir / "b.svg");
        { base::AtomicFile third(dir / "c.svg"); }
        base::AtomicFile fourth(dir / "d.csv");
        fourth.commit();
        if (dir.names().size() != 3) _exit(1);
        raise(SIGTERM);
      },
      ::testing::ExitedWithCode(143), "");
  EXPECT_EQ(dir.names(), (std::vector<std::string>{"d.csv"}));
}

TEST(InterruptDeathTest, AFileBeyondTheLimitIsAnErrorAndRemoved) {
  const tests::TemporaryDirectory dir;
  EXPECT_EXIT(
      {
        install_interrupt_handlers();
        limit_file_size(1 << 16);
        try {
          base::AtomicFile file(dir / "out.csv");
          file.write(std::string(3 << 20, 'x'));
          file.commit();
        } catch (const base::FileError& error) {
          _exit(static_cast<int>(error_from_file(error).exit_code()));
        }
        _exit(0);
      },
      ::testing::ExitedWithCode(8), "");
  EXPECT_TRUE(dir.names().empty());
}

TEST(InterruptDeathTest, KeepsIgnoredSignalsIgnored) {
  EXPECT_EXIT(
      {
        signal(SIGHUP, SIG_IGN);
        install_interrupt_handlers();
        raise(SIGHUP);
        _exit(0);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace affskel::client
