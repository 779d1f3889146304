#include "client/cli/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>

#include "base/kept_text.h"
#include "base/temporary_files.h"

namespace affskel::client {
namespace {

// Published to the handler, which may come at any time.
std::atomic<const char*> message_text{nullptr};

static_assert(std::atomic<const char*>::is_always_lock_free);

void on_signal(int signal_number) {
  base::remove_guarded_files();
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
  message_text.store(base::kept_text(text));
}

}  // namespace affskel::client
