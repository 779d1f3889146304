#include "base/end_limit.h"

#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <ctime>
#include <string_view>

namespace affskel::base {
namespace {

// Read by the handler; written before limit_end() can set it off.
EndLimit end_limit;

enum class State { kNotSet, kSet, kLimited };
std::atomic<State> state{State::kNotSet};
static_assert(std::atomic<State>::is_always_lock_free);

/// A line of the log in memory of its own: spdlog's locks may be held by what hangs.
class Line {
 public:
  void add(std::string_view text) {
    const std::size_t size = std::min(text.size(), bytes_.size() - size_);
    std::copy_n(text.data(), size, bytes_.data() + size_);
    size_ += size;
  }

  /// With so many digits.
  void add(std::int64_t number, int digits) {
    std::array<char, 20> text{};
    for (int i = digits; i-- > 0; number /= 10)
      text[static_cast<std::size_t>(i)] = static_cast<char>('0' + number % 10);
    add({text.data(), static_cast<std::size_t>(digits)});
  }

  /// As kLogPattern has it; gmtime is not for signal handlers.
  void add_time() {
    using namespace std::chrono;
    const auto now = floor<milliseconds>(system_clock::now());
    const auto day = floor<days>(now);
    const year_month_day date(day);
    const hh_mm_ss time(now - day);
    add("time=");
    add(int{date.year()}, 4);
    add("-");
    add(unsigned{date.month()}, 2);
    add("-");
    add(unsigned{date.day()}, 2);
    add("T");
    add(time.hours().count(), 2);
    add(":");
    add(time.minutes().count(), 2);
    add(":");
    add(time.seconds().count(), 2);
    add(".");
    add(time.subseconds().count(), 3);
    add("Z");
  }

  /// Less than PIPE_BUF: a pipe that has room takes it whole.
  void write_if_taken(int fd) const {
    pollfd room{fd, POLLOUT, 0};
    if (poll(&room, 1, 0) == 1) [[maybe_unused]]
      const ssize_t written = write(fd, bytes_.data(), size_);
  }

 private:
  std::array<char, 500> bytes_;
  std::size_t size_ = 0;
};

void on_alarm(int) {
  if (end_limit.before != nullptr) end_limit.before();
  leave_at_once("critical", end_limit.entry, end_limit.exit_code);
}

}  // namespace

void set_end_limit(const EndLimit& limit) {
  end_limit = limit;
  struct sigaction action {};
  action.sa_handler = on_alarm;
  sigfillset(&action.sa_mask);
  sigaction(SIGALRM, &action, nullptr);
  // The process that started this one may have blocked it.
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGALRM);
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  state = State::kSet;
}

void limit_end() noexcept {
  State expected = State::kSet;
  // The kernel has this timer, for every process, at all times: unlike timer_create's it cannot be refused.
  if (state.compare_exchange_strong(expected, State::kLimited)) {
    alarm(static_cast<unsigned>(end_limit.limit.count()));
  }
}

void leave_at_once(const char* level, const char* entry, int exit_code) noexcept {
  Line line;
  line.add_time();
  line.add(" level=");
  line.add(level);
  line.add(" ");
  line.add(entry);
  line.add("\n");
  line.write_if_taken(STDERR_FILENO);
  _exit(exit_code);
}

}  // namespace affskel::base
