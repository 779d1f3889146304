#include "client/cli/budget.h"

#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

#include "base/kept_text.h"
#include "base/temporary_files.h"
#include "client/base/error.h"

namespace affskel::client {
namespace {

// Published to what may come at any time.
std::atomic<const char*> time_text{nullptr}, memory_text{nullptr};

static_assert(std::atomic<const char*>::is_always_lock_free);

[[noreturn]] void leave(const char* text) {
  base::remove_guarded_files();
  if (text != nullptr) {
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text, std::strlen(text));
  }
  _exit(static_cast<int>(ExitCode::kLimit));
}

void on_time(int) {
  leave(time_text.load());
}

void on_memory() {
  leave(memory_text.load());
}

// As the console would show it.
const char* message(const Console& console, const std::string& text, const std::string& file) {
  std::ostringstream out, err;
  Console(out, err, console.style()).error(ClientError(ExitCode::kLimit, text, file));
  return base::kept_text(err.str());
}

// Memory that the process has for its data, bytes; what the kernel holds to RLIMIT_DATA.
rlim_t data_bytes() {
  std::ifstream statm("/proc/self/statm");
  rlim_t pages = 0;
  for (int field = 0; field < 6; ++field) statm >> pages;
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

// Of processor time, from now on; 0: none.
void set_alarm(std::uint64_t seconds) {
  itimerval timer{};
  timer.it_value.tv_sec =
      static_cast<time_t>(std::min<std::uint64_t>(seconds, std::numeric_limits<std::int32_t>::max()));
  setitimer(ITIMER_PROF, &timer, nullptr);
}

}  // namespace

Budget::Budget(const Console& console, const Budgets& budgets, Work work, const std::string& file)
    : limits_memory_(budgets.memory > 0) {
  const bool reading = work == Work::kReading;
  const std::string what =
      reading ? "reading it takes more than " : "mending and checking it takes more than ";
  const std::uint64_t seconds = reading ? budgets.read_limit_s : budgets.repair_limit_s;
  time_text = message(console,
                      what + std::to_string(seconds) + " s of processor time (" +
                          (reading ? "--read-limit" : "--repair-limit") + ")",
                      file);
  signal(SIGPROF, on_time);
  set_alarm(seconds);
  if (!limits_memory_) return;
  memory_text = message(console, what + std::to_string(budgets.memory) + " bytes of memory (--memory)", file);
  handler_ = std::set_new_handler(on_memory);
  getrlimit(RLIMIT_DATA, &data_);
  rlimit limit = data_;
  const rlim_t used = data_bytes();
  limit.rlim_cur = std::min(data_.rlim_cur, used + std::min<rlim_t>(budgets.memory, RLIM_INFINITY - used));
  setrlimit(RLIMIT_DATA, &limit);
}

Budget::~Budget() {
  set_alarm(0);
  if (!limits_memory_) return;
  setrlimit(RLIMIT_DATA, &data_);
  std::set_new_handler(handler_);
}

}  // namespace affskel::client
