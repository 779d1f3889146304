#include "base/reaped.h"

#include <sys/wait.h>

#include <cerrno>
#include <thread>
#include <utility>

namespace affskel::base {

std::future<std::optional<int>> reaped(pid_t child) {
  std::promise<std::optional<int>> ended;
  std::future<std::optional<int>> status = ended.get_future();
  std::thread([child, end = std::move(ended)]() mutable {
    int found = 0;
    pid_t told = 0;
    do {
      told = waitpid(child, &found, 0);
    } while (told < 0 && errno == EINTR);
    end.set_value(told == child ? std::optional(found) : std::nullopt);
  }).detach();
  return status;
}

}  // namespace affskel::base
