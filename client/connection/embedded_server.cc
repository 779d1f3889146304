#include "client/connection/embedded_server.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <future>
#include <optional>
#include <thread>
#include <vector>

#include "base/find_program.h"
#include "base/reaped.h"
#include "client/base/error.h"
#include "wire/sha256.h"

extern char** environ;

namespace affskel::client {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxSocketPath = sizeof(sockaddr_un::sun_path) - 1;
constexpr const char* kServerName = "affskel-server";

// The last lines of a log that may be long.
std::string tail_of(const fs::path& file, std::size_t lines) {
  constexpr std::streamoff kWindow = 16384;
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) return {};
  const std::streamoff size = in.tellg();
  in.seekg(std::max<std::streamoff>(0, size - kWindow));
  std::vector<std::string> all;
  for (std::string line; std::getline(in, line);) all.push_back(line);
  std::string text;
  for (std::size_t i = all.size() - std::min(all.size(), lines); i < all.size(); ++i) text += "\n  " + all[i];
  return text;
}

// Attributes of a child that outlives us: own session, default signals, nothing of ours open.
class DetachedSpawn {
 public:
  explicit DetachedSpawn(const fs::path& log) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_APPEND,
                                     0600);
    posix_spawn_file_actions_addclosefrom_np(&actions_, STDERR_FILENO + 1);
    posix_spawn_file_actions_addchdir_np(&actions_, "/");
    posix_spawnattr_init(&attributes_);
    sigset_t none;
    sigset_t all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    posix_spawnattr_setflags(&attributes_,
                             POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~DetachedSpawn() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  DetachedSpawn(const DetachedSpawn&) = delete;
  DetachedSpawn& operator=(const DetachedSpawn&) = delete;

  pid_t run(const std::vector<std::string>& arguments) {
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    pid_t pid = 0;
    const int error = posix_spawn(&pid, argv[0], &actions_, &attributes_, argv.data(), environ);
    if (error != 0) {
      throw ClientError(ExitCode::kUnreachable, "cannot start " + arguments[0] + ": " + std::strerror(error));
    }
    return pid;
  }

 private:
  posix_spawn_file_actions_t actions_;
  posix_spawnattr_t attributes_;
};

// One old log is kept.
void rotate(const fs::path& log) {
  constexpr std::uintmax_t kMaxLogBytes = 8u << 20;
  std::error_code error;
  const std::uintmax_t size = fs::file_size(log, error);
  if (!error && size > kMaxLogBytes) fs::rename(log, log.string() + ".1", error);
}

// Its status when it has left.  Idle, it leaves before a client that stays, as `web` does, which then starts
// another: each is reaped, so that none is a zombie until the client ends.
std::future<std::optional<int>> start_server(const EmbeddedPaths& paths, const fs::path& program) {
  return base::reaped(DetachedSpawn(paths.log).run({program, "--data-dir", paths.home, "--listen",
                                                    "unix:" + paths.socket.string(), "--workers", "auto",
                                                    "--idle-exit", "60"}));
}

// How the child ended, and with which code the client does.
struct End {
  std::string how;
  ExitCode code = ExitCode::kUnreachable;
};

End end_of(int status) {
  if (WIFSIGNALED(status)) return End{"was killed by signal " + std::to_string(WTERMSIG(status))};
  const int code = WEXITSTATUS(status);
  // Client and server have the same exit code for a full disk.
  const bool full = code == static_cast<int>(ExitCode::kLimit);
  return End{"exited with code " + std::to_string(code), full ? ExitCode::kLimit : ExitCode::kUnreachable};
}

[[noreturn]] void give_up(const EmbeddedPaths& paths, const End& end) {
  throw ClientError(
      end.code, "the private server " + end.how + "; the end of its log:" + tail_of(paths.log, 8), paths.log);
}

void wait_for_socket(const EmbeddedPaths& paths, const EmbeddedOptions& options,
                     std::future<std::optional<int>> status) {
  Clock::time_point deadline = Clock::now() + options.patience;
  std::optional<End> end;
  while (!wire::socket_answers(paths.socket)) {
    if (status.valid() && status.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
      if (const std::optional<int> how = status.get()) {
        end = end_of(*how);
        deadline = std::min(deadline, Clock::now() + options.grace);
      }
    }
    if (Clock::now() >= deadline) give_up(paths, end.value_or(End{"does not answer on its socket"}));
    std::this_thread::sleep_for(options.poll);
  }
}

}  // namespace

EmbeddedPaths embedded_paths(const Environment& environment) {
  EmbeddedPaths paths;
  const auto home = environment.get("AFFSKEL_HOME");
  const fs::path data =
      home ? fs::path(*home) : xdg_directory(environment, "XDG_DATA_HOME", ".local/share") / "affskel";
  paths.home = fs::absolute(data).lexically_normal();  // the server works in a directory of its own
  paths.log = paths.home / "server.log";
  paths.socket = paths.home / "server.sock";
  if (paths.socket.native().size() <= kMaxSocketPath) return paths;
  const std::string name = wire::sha256_hex(paths.home.native()).substr(0, 16);
  const auto runtime = environment.get("XDG_RUNTIME_DIR");
  const bool fits = runtime && fs::path(*runtime).is_absolute() && runtime->size() < 60;
  paths.socket_dir = fits ? fs::path(*runtime) / ("affskel-" + name)
                          : fs::path("/tmp") / ("affskel-" + std::to_string(geteuid()) + "-" + name);
  paths.socket = paths.socket_dir / "server.sock";
  return paths;
}

void make_private_directory(const fs::path& directory, bool only_ours) {
  std::error_code error;
  fs::create_directories(directory.parent_path(), error);
  if (error) throw error_from_errno(error.value(), "cannot create", directory.parent_path());
  if (mkdir(directory.c_str(), 0700) != 0 && errno != EEXIST) {
    throw error_from_errno(errno, "cannot create", directory);
  }
  struct stat info {};
  const int result = only_ours ? lstat(directory.c_str(), &info) : stat(directory.c_str(), &info);
  if (result != 0) throw error_from_errno(errno, "cannot read", directory);
  if (!S_ISDIR(info.st_mode)) throw ClientError(ExitCode::kNotAllowed, "is not a directory", directory);
  if (info.st_uid != geteuid()) {
    throw ClientError(ExitCode::kNotAllowed, "belongs to another user; a private server will not use it",
                      directory);
  }
  if (only_ours && (info.st_mode & 077) != 0) {
    throw ClientError(ExitCode::kNotAllowed, "other users can enter it; expected mode 0700", directory);
  }
}

fs::path find_server_program(const fs::path& beside, const Environment& environment) {
  fs::path found = base::find_program(kServerName, beside, environment.get("PATH").value_or(""));
  if (!found.empty()) return found;
  throw ClientError(ExitCode::kUnreachable, "no server is configured, and affskel-server is neither in " +
                                                beside.string() +
                                                " nor in $PATH; name a server with --server ADDR");
}

wire::Address ensure_embedded_server(const EmbeddedPaths& paths, const EmbeddedOptions& options,
                                     const Environment& environment, const Listener& listener) {
  make_private_directory(paths.home, false);
  if (!paths.socket_dir.empty()) make_private_directory(paths.socket_dir, true);
  if (!wire::socket_answers(paths.socket)) {
    const fs::path program =
        options.program.empty() ? find_server_program(base::own_directory(), environment) : options.program;
    if (listener) {
      listener(note("SERVER_STARTED", "starting a private server; its data is in " + paths.home.string() +
                                          ", it leaves by itself when idle"));
    }
    rotate(paths.log);
    wait_for_socket(paths, options, start_server(paths, program));
  }
  wire::Address address;
  address.is_unix = true;
  address.path = paths.socket;
  return address;
}

}  // namespace affskel::client
