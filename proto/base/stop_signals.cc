#include "base/stop_signals.h"

#include <pthread.h>

#include <csignal>
#include <utility>

#include "base/end_limit.h"

namespace affskel::base {
namespace {

// SIGUSR2 only wakes the thread up so that it can be joined.
sigset_t taken_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGTERM, SIGINT, SIGUSR2}) sigaddset(&set, number);
  return set;
}

void take_signals(const std::function<void(int)>& on_stop) {
  const sigset_t taken = taken_signals();
  for (int number = 0; number != SIGUSR2;) {
    if (sigwait(&taken, &number) != 0 || number == SIGUSR2) continue;
    limit_end();
    on_stop(number);
  }
}

}  // namespace

StopSignals::StopSignals(std::function<void(int)> on_stop) {
  const sigset_t set = taken_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  thread_ = std::thread([on_stop = std::move(on_stop)] { take_signals(on_stop); });
}

StopSignals::~StopSignals() {
  pthread_kill(thread_.native_handle(), SIGUSR2);
  thread_.join();
}

}  // namespace affskel::base
