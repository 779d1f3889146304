#include "base/reaped.h"

#include <sys/wait.h>

#include <cerrno>
#include <thread>
#include <utility>

namespace affskel::base {

std::future<int> reaped(pid_t child) {
  std::promise<int> ended;
  std::future<int> status = ended.get_future();
  std::thread([child, end = std::move(ended)]() mutable {
    int found = 0;
    while (waitpid(child, &found, 0) < 0 && errno == EINTR) {
    }
    end.set_value(found);
  }).detach();
  return status;
}

}  // namespace affskel::base
