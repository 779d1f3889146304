#include "client/web/open_browser.h"

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <future>
#include <optional>

#include "base/atomic_file.h"
#include "base/reaped.h"

extern char** environ;

namespace affskel::client {
namespace {

// xdg-open fails within it, where it does; a browser that it becomes stays.
constexpr std::chrono::seconds kLooked{2};

// Whether it fails within kLooked.
bool fails_soon(pid_t child) {
  std::future<std::optional<int>> status = base::reaped(child);
  return status.wait_for(kLooked) == std::future_status::ready && status.get().value_or(0) != 0;
}

}  // namespace

bool open_browser(const std::string& address, const std::filesystem::path& file,
                  const Environment& environment) {
  if (!environment.get("DISPLAY") && !environment.get("WAYLAND_DISPLAY")) return false;
  base::AtomicFile page(file);
  page.write(
      "<!DOCTYPE html><meta charset=\"utf-8\"><title>affskel</title>"
      "<meta http-equiv=\"refresh\" content=\"0; url=" +
      address + "\">\n");
  page.commit();
  std::string program = "xdg-open", argument = file.string();
  const std::array<char*, 3> argv = {program.data(), argument.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, fd, "/dev/null", O_RDWR, 0);
  posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  pid_t pid = 0;
  const int error = posix_spawnp(&pid, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return error == 0 && !fails_soon(pid);
}

}  // namespace affskel::client
