#include "stop_signal.h"

#include <pthread.h>

#include <csignal>

namespace affskel::worker {
namespace {

// SIGUSR2 only wakes the thread up so that it can be joined.
sigset_t handled_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGUSR2);
  return set;
}

}  // namespace

StopSignal::StopSignal() {
  const sigset_t set = handled_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  thread_ = std::thread([this] {
    const sigset_t awaited = handled_signals();
    int signal = 0;
    while (sigwait(&awaited, &signal) != 0) {
    }
    source_.request_stop();
  });
}

StopSignal::~StopSignal() {
  pthread_kill(thread_.native_handle(), SIGUSR2);
  thread_.join();
}

}  // namespace affskel::worker
