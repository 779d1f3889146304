#include "client/cli/budget.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <new>
#include <sstream>
#include <string>

#include "base/atomic_file.h"
#include "tools/temporary_directory.h"

namespace affskel::client {
namespace {

constexpr int kLimit = static_cast<int>(ExitCode::kLimit);

struct Screen {
  explicit Screen(bool json = false) : console(out, err, style(json)) {}
  static ConsoleStyle style(bool json) {
    ConsoleStyle style;
    style.json = json;
    return style;
  }
  std::ostringstream out, err;
  Console console;
};

[[noreturn]] void work_for_ever() {
  for (std::atomic<unsigned> i = 0;;) ++i;
}

void take(std::size_t bytes) {
  const std::string memory(bytes, 'x');
  if (memory.back() != 'x') _exit(1);
}

// Each runs in a process of its own; the work asks nobody.
TEST(BudgetDeathTest, SaysThatReadingMetItsTime) {
  const Screen screen;
  EXPECT_EXIT(
      {
        const Budget budget(screen.console, {.read_limit_s = 1}, Budget::Work::kReading, "scan.ply");
        work_for_ever();
      },
      ::testing::ExitedWithCode(kLimit),
      "error: scan.ply: reading it takes more than 1 s of processor time \\(--read-limit\\)");
}

TEST(BudgetDeathTest, SaysThatARepairMetItsTimeAsJsonAndRemovesTheUnfinishedFile) {
  const tests::TemporaryDirectory dir;
  const Screen screen(true);
  EXPECT_EXIT(
      {
        base::AtomicFile file(dir / "out.off");
        file.write(std::string(3 << 20, 'x'));
        if (dir.names().size() != 1) _exit(1);
        const Budget budget(screen.console, {.repair_limit_s = 1}, Budget::Work::kRepair, "scan.ply");
        work_for_ever();
      },
      ::testing::ExitedWithCode(kLimit),
      "\\{\"error\":\\{\"code\":\"LIMIT\",\"message\":\"mending and checking it takes more than 1 s of "
      "processor time \\(--repair-limit\\)\",\"file\":\"scan.ply\"\\}\\}");
  EXPECT_TRUE(dir.names().empty());
}

TEST(BudgetDeathTest, SaysThatItMetItsMemory) {
  const Screen screen;
  EXPECT_EXIT(
      {
        const Budget budget(screen.console, {.memory = 64 << 20}, Budget::Work::kReading, "scan.ply");
        take(32 << 20);
        take(128 << 20);
        _exit(0);
      },
      ::testing::ExitedWithCode(kLimit),
      "error: scan.ply: reading it takes more than 67108864 bytes of memory \\(--memory\\)");
}

// What it has by then and all that there can be are still no more than all.
TEST(BudgetDeathTest, TheGreatestMemoryIsNone) {
  const Screen screen;
  EXPECT_EXIT(
      {
        const Budgets budgets{.memory = ~std::uint64_t{0}};
        const Budget budget(screen.console, budgets, Budget::Work::kReading, "scan.ply");
        take(128 << 20);
        _exit(0);
      },
      ::testing::ExitedWithCode(0), "");
}

// 0 when time, memory and what is asked for more are as they were.
[[noreturn]] void work_after_a_budget() {
  const Screen screen;
  rlimit before{}, after{};
  getrlimit(RLIMIT_DATA, &before);
  {
    const Budgets budgets{.read_limit_s = 1, .memory = 1 << 20};
    const Budget budget(screen.console, budgets, Budget::Work::kReading, "scan.ply");
  }
  getrlimit(RLIMIT_DATA, &after);
  take(128 << 20);
  itimerval timer{};
  getitimer(ITIMER_PROF, &timer);
  const bool ended = before.rlim_cur == after.rlim_cur && timer.it_value.tv_sec == 0 &&
                     timer.it_value.tv_usec == 0 && std::get_new_handler() == nullptr;
  _exit(ended ? 0 : 1);
}

TEST(BudgetDeathTest, EndsWithTheWork) {
  EXPECT_EXIT(work_after_a_budget(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace affskel::client
