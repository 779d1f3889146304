#include "process/supervisor.h"

#include <fcntl.h>
#include <signal.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "base/exit_code.h"
#include "base/find_program.h"
#include "base/logfmt.h"

namespace affskel::server {
namespace {

constexpr std::chrono::milliseconds kReapPause{10};

/// The child between fork and exec: only async-signal-safe calls, other threads' locks are lost here.
[[noreturn]] void become_worker(char* const* arguments, char* const* environment, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(0);  // the server died before the line above
  // A group of its own: Ctrl-C is for the server, which tells its workers.
  setpgid(0, 0);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  signal(SIGPIPE, SIG_DFL);
  const int null = open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (null >= 0) dup2(null, STDIN_FILENO);
  dup2(STDERR_FILENO, STDOUT_FILENO);
  execve(arguments[0], arguments, environment);
  _exit(127);
}

/// That of this process without the socket of its service manager, which asks for the server's state alone.
std::vector<char*> environment_of_worker() {
  constexpr std::string_view kNotifySocket = "NOTIFY_SOCKET=";
  std::vector<char*> environment;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    if (!std::string_view(*entry).starts_with(kNotifySocket)) environment.push_back(*entry);
  }
  environment.push_back(nullptr);
  return environment;
}

base::LogField describe(int status) {
  if (WIFEXITED(status)) return {"exit", WEXITSTATUS(status)};
  return {"signal", WTERMSIG(status)};
}

/// Leaves it to be waited for: until then its number is no other process's.
bool has_ended(pid_t pid, int options) {
  siginfo_t state{};
  return waitid(P_PID, static_cast<id_t>(pid), &state, WEXITED | WNOWAIT | options) == 0 &&
         state.si_pid == pid;
}

}  // namespace

Supervisor::Supervisor(SupervisorOptions options, Callback on_start, Callback on_end)
    : options_(std::move(options)),
      on_start_(std::move(on_start)),
      on_end_(std::move(on_end)),
      slots_(options_.workers) {}

Supervisor::~Supervisor() {
  terminate(std::chrono::milliseconds(0));
}

void Supervisor::tick() {
  reap();
  const Time now = std::chrono::steady_clock::now();
  for (Slot& slot : slots_) {
    if (!terminating_ && !slot.barred && slot.pid == 0 && slot.due <= now) start(slot);
  }
}

void Supervisor::reap() {
  for (Slot& slot : slots_) {
    if (slot.pid != 0 && has_ended(slot.pid, WNOHANG)) ended(slot);
  }
}

void Supervisor::start(Slot& slot) {
  std::vector<char*> arguments;
  for (const std::string& word : options_.command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const std::vector<char*> environment = environment_of_worker();
  const pid_t self = getpid();
  const pid_t child = fork();
  if (child == 0) become_worker(arguments.data(), environment.data(), self);
  slot.started = std::chrono::steady_clock::now();
  if (child < 0) {
    slot.delay = std::clamp(slot.delay * 2, options_.first_delay, options_.last_delay);
    slot.due = slot.started + slot.delay;
    spdlog::error(
        base::logfmt("worker_start_failed", {{"message", std::string("fork: ") + std::strerror(errno)}}));
    return;
  }
  slot.pid = child;
  spdlog::info(base::logfmt("worker_started", {{"pid", child}}));
  on_start_(child);
}

void Supervisor::ended(Slot& slot) {
  const pid_t pid = slot.pid.exchange(0);
  int status = 0;
  waitpid(pid, &status, 0);
  const Time now = std::chrono::steady_clock::now();
  if (now - slot.started >= options_.healthy) {
    slot.delay = std::chrono::milliseconds(0);
  } else {
    slot.delay = std::clamp(slot.delay * 2, options_.first_delay, options_.last_delay);
  }
  slot.due = now + slot.delay;
  slot.barred = WIFEXITED(status) && WEXITSTATUS(status) == static_cast<int>(base::ExitCode::kNotAllowed) &&
                options_.is_distrusted(pid);
  if (terminating_) {
    spdlog::info(base::logfmt("worker_ended", {{"pid", pid}, describe(status)}));
  } else if (slot.barred) {
    spdlog::error(base::logfmt("worker_ended", {{"pid", pid},
                                                describe(status),
                                                {"message",
                                                 "an administrator distrusts it; none is started in its"
                                                 " place until the server is started anew"}}));
  } else if (WIFEXITED(status) && WEXITSTATUS(status) == 127) {
    spdlog::error(base::logfmt("worker_ended", {{"pid", pid},
                                                {"restart_ms", slot.delay.count()},
                                                {"message", "cannot run " + options_.command[0]}}));
  } else {
    spdlog::warn(
        base::logfmt("worker_ended", {{"pid", pid}, describe(status), {"restart_ms", slot.delay.count()}}));
  }
  on_end_(pid);
}

void Supervisor::terminate(std::chrono::milliseconds grace, const std::function<bool()>& hurry) {
  terminating_ = true;
  for (const Slot& slot : slots_) {
    if (slot.pid != 0) kill(slot.pid, SIGTERM);
  }
  const Time deadline = std::chrono::steady_clock::now() + grace;
  for (reap(); running() > 0 && std::chrono::steady_clock::now() < deadline && !hurry(); reap()) {
    std::this_thread::sleep_for(kReapPause);
  }
  for (Slot& slot : slots_) {
    if (slot.pid == 0) continue;
    spdlog::warn(base::logfmt("worker_killed",
                              {{"pid", slot.pid.load()},
                               {"message", "did not end within " + std::to_string(grace.count()) + " ms"}}));
    kill(slot.pid, SIGKILL);
    if (has_ended(slot.pid, 0)) ended(slot);
  }
}

void Supervisor::kill_all() const noexcept {
  for (const Slot& slot : slots_) {
    if (const pid_t pid = slot.pid; pid != 0) kill(pid, SIGKILL);
  }
}

unsigned Supervisor::running() const {
  return static_cast<unsigned>(
      std::count_if(slots_.begin(), slots_.end(), [](const Slot& slot) { return slot.pid != 0; }));
}

std::string find_worker_binary(const std::string& given) {
  if (!given.empty()) {
    if (!base::is_program(given)) throw std::runtime_error("--worker-binary " + given + ": not a program");
    return std::filesystem::absolute(given).string();
  }
  const char* path = std::getenv("PATH");
  const std::filesystem::path found =
      base::find_program("affskel-worker", base::own_directory(), path == nullptr ? "" : path);
  if (!found.empty()) return found.string();
  throw std::runtime_error(
      "--workers: no program affskel-worker next to affskel-server or on the PATH;"
      " give --worker-binary FILE");
}

}  // namespace affskel::server
