#include "terminal.h"

#include <poll.h>
#include <pty.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <utility>

namespace affskel::integration {
namespace {

constexpr int kPatienceMs = 120000;  // for a loaded machine; nothing waits for it when all is well

[[noreturn]] void execute_line(const std::string& line, const std::vector<std::string>& environment) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  setenv("TERM", "xterm", 1);
  setenv("PS1", "$ ", 1);
  unsetenv("NO_COLOR");
  for (const std::string& entry : environment) putenv(const_cast<char*>(entry.c_str()));
  if (line.empty()) {
    execl("/bin/bash", "bash", "--norc", "--noprofile", "-i", nullptr);
  } else {
    execl("/bin/bash", "bash", "--norc", "--noprofile", "-c", line.c_str(), nullptr);
  }
  _exit(127);
}

}  // namespace

Terminal::Terminal(const std::string& line, const std::vector<std::string>& environment) {
  winsize size{};
  size.ws_row = 40;
  size.ws_col = 120;
  pid_ = forkpty(&fd_, nullptr, nullptr, &size);
  if (pid_ < 0) throw std::runtime_error("no pseudo-terminal");
  if (pid_ == 0) execute_line(line, environment);
}

Terminal::~Terminal() {
  if (exit_code_ < 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close(fd_);
}

void Terminal::type(const std::string& keys) const {
  if (write(fd_, keys.data(), keys.size()) != static_cast<ssize_t>(keys.size()))
    throw std::runtime_error("cannot type into the terminal");
}

// False at the end: the kernel answers EIO when no program has the terminal open any more.
bool Terminal::read_some() {
  pollfd ready{fd_, POLLIN, 0};
  const int count = poll(&ready, 1, kPatienceMs);
  if (count < 0 && errno == EINTR) return true;
  if (count == 0) throw std::runtime_error("the terminal is silent after:\n" + shown_);
  std::array<char, 4096> buffer{};
  const ssize_t got = read(fd_, buffer.data(), buffer.size());
  if (got <= 0) return got < 0 && errno == EINTR;
  shown_.append(buffer.data(), static_cast<std::size_t>(got));
  return true;
}

std::string Terminal::read_until(const std::string& text) {
  for (;;) {
    const std::size_t at = shown_.find(text);
    if (at != std::string::npos) {
      const std::string part = shown_.substr(0, at + text.size());
      shown_.erase(0, at + text.size());
      return part;
    }
    if (!read_some()) throw std::runtime_error("'" + text + "' was not shown but:\n" + shown_);
  }
}

std::string Terminal::read_all() {
  while (read_some()) {
  }
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return std::exchange(shown_, {});
}

}  // namespace affskel::integration
