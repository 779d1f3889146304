#include "client/cli/interrupt.h"
#include "base/mutex.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <deque>

namespace affskel::client {
namespace {

// A signal handler may only read what is never freed or changed under it: strings are published through an
// atomic pointer, and replaced ones are kept to the end (a few dozen bytes per file written).
std::atomic<const char*> message_text{nullptr};
std::array<std::atomic<const char*>, 8> temporary_paths{};

static_assert(std::atomic<const char*>::is_always_lock_free);

const char* publish(const std::string& text) {
  static base::Mutex mutex;
  static auto& kept = *new std::deque<std::string>;  // not destroyed at exit, where a signal may still come
  if (text.empty()) return nullptr;
  const base::MutexLock lock(mutex);
  return kept.emplace_back(text).c_str();
}

void on_signal(int signal_number) {
  for (const std::atomic<const char*>& slot : temporary_paths) {
    if (const char* path = slot.load()) unlink(path);
  }
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
  // Both then fail as writes do, with a message.
  signal(SIGXFSZ, SIG_IGN);
  signal(SIGPIPE, SIG_IGN);
}

void set_interrupt_message(const std::string& text) {
  message_text.store(publish(text));
}

void guard_temporary_file(const std::string& path) {
  const char* const published = publish(path);
  for (std::atomic<const char*>& slot : temporary_paths) {
    const char* free = nullptr;
    if (slot.compare_exchange_strong(free, published)) return;
  }
}

void release_temporary_file(const std::string& path) {
  for (std::atomic<const char*>& slot : temporary_paths) {
    const char* const guarded = slot.load();
    if (guarded != nullptr && path == guarded) slot.store(nullptr);
  }
}

}  // namespace affskel::client
