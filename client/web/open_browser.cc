#include "client/web/open_browser.h"

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <array>

#include "base/atomic_file.h"

extern char** environ;

namespace affskel::client {

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
  return error == 0;
}

}  // namespace affskel::client
