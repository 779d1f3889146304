#include "client/interrupt.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <deque>
#include <mutex>

namespace affskel::client {
namespace {

// A signal handler may only read what is never freed or changed under it: strings are published through an
// atomic pointer, and replaced ones are kept to the end (a few dozen bytes per file written).
std::atomic<const char*> message_text{nullptr};
std::atomic<const char*> temporary_path{nullptr};

static_assert(std::atomic<const char*>::is_always_lock_free);

const char* publish(const std::string& text) {
  static std::mutex mutex;
  static auto& kept = *new std::deque<std::string>;  // not destroyed at exit, where a signal may still come
  if (text.empty()) return nullptr;
  const std::lock_guard lock(mutex);
  return kept.emplace_back(text).c_str();
}

void on_signal(int signal_number) {
  if (const char* path = temporary_path.load()) unlink(path);
  if (const char* text = message_text.load()) {
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text, std::strlen(text));
  }
  _exit(128 + signal_number);
}

}  // namespace

void install_interrupt_handlers() {
  for (const int signal_number : std::array{SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction current {};
    sigaction(signal_number, nullptr, &current);
    if (current.sa_handler == SIG_IGN) continue;  // nohup and background jobs keep their choice
    struct sigaction action {};
    action.sa_handler = on_signal;
    sigaction(signal_number, &action, nullptr);
  }
}

void set_interrupt_message(const std::string& text) {
  message_text.store(publish(text));
}

void guard_temporary_file(const std::string& path) {
  temporary_path.store(publish(path));
}

void release_temporary_file() {
  temporary_path.store(nullptr);
}

}  // namespace affskel::client
