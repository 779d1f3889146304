#include "process/signals.h"

#include <ctime>

#include "base/end_limit.h"
#include "base/exit_code.h"

namespace affskel::server {
namespace {

/// Children's ends, as which this thread is told of signals to stop, too.
sigset_t block_waking() {
  signal(SIGPIPE, SIG_IGN);
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGCHLD);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  return set;
}

}  // namespace

Signals::Signals() : waking_(block_waking()), signals_([this](int number) { take(number); }) {}

void Signals::take(int number) {
  if (!serving_) {
    base::leave_at_once("info",
                        number == SIGINT ? "event=stopping signal=2 message=\"during the start\""
                                         : "event=stopping signal=15 message=\"during the start\"",
                        static_cast<int>(base::ExitCode::kDone));
  }
  number_ = number;
  ++count_;
  pthread_kill(main_, SIGCHLD);
}

void Signals::wait(std::chrono::nanoseconds patience) const {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(patience);
  const timespec time{static_cast<time_t>(seconds.count()), static_cast<long>((patience - seconds).count())};
  sigtimedwait(&waking_, nullptr, &time);
}

}  // namespace affskel::server
