#include "process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <utility>

namespace affskel::chaos {
namespace {

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

void redirect(const char* path, int to) {
  const int fd = open(path, O_WRONLY | O_CREAT | O_APPEND, 0600);
  if (fd >= 0) dup2(fd, to);
}

// Between fork and exec of a program with threads nothing may allocate: all is made before.
pid_t start(const Command& command) {
  std::vector<std::string> arguments = command.arguments, environment = command.environment;
  for (char** entry = environ; *entry != nullptr; ++entry) environment.emplace_back(*entry);
  const std::vector<char*> argv = pointers(arguments), envp = pointers(environment);
  const std::string out = command.out.empty() ? "/dev/null" : command.out;
  const std::string err = command.err.empty() ? "/dev/null" : command.err;
  const pid_t pid = fork();
  if (pid != 0) return pid;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  dup2(open("/dev/null", O_RDONLY), 0);
  redirect(out.c_str(), 1);
  redirect(err.c_str(), 2);
  execve(argv[0], argv.data(), envp.data());
  _exit(127);
}

}  // namespace

Process::Process(const Command& command) : pid_(start(command)) {
  if (pid_ < 0) throw std::runtime_error("no process can be made");
  fd_ = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));
  if (fd_ < 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    throw std::runtime_error("pidfd_open failed");
  }
}

Process::~Process() {
  kill_hard();
}

Process::Process(Process&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), fd_(std::exchange(other.fd_, -1)) {}

Process& Process::operator=(Process&& other) noexcept {
  if (this == &other) return *this;
  kill_hard();
  pid_ = std::exchange(other.pid_, -1);
  fd_ = std::exchange(other.fd_, -1);
  return *this;
}

bool Process::alive() const {
  return !one_ends({this, 1}, std::chrono::milliseconds(0));
}

bool Process::one_ends(std::span<const Process> processes, std::chrono::milliseconds patience) {
  std::vector<pollfd> ends;
  for (const Process& process : processes) {
    if (process.pid_ <= 0) return true;
    ends.push_back({process.fd_, POLLIN, 0});
  }
  return poll(ends.data(), ends.size(), static_cast<int>(patience.count())) > 0;
}

void Process::send(int signal) const {
  if (pid_ > 0) kill(pid_, signal);
}

std::optional<int> Process::wait(std::chrono::milliseconds patience) {
  pollfd end{fd_, POLLIN, 0};
  if (pid_ <= 0 || poll(&end, 1, static_cast<int>(patience.count())) != 1) return std::nullopt;
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  reap();
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void Process::reap() {
  close(fd_);
  pid_ = fd_ = -1;
}

void Process::kill_hard() {
  if (pid_ <= 0) return;
  send(SIGKILL);
  waitpid(pid_, nullptr, 0);
  reap();
}

std::optional<int> run(const Command& command, std::chrono::milliseconds patience) {
  Process process(command);
  return process.wait(patience);
}

}  // namespace affskel::chaos
