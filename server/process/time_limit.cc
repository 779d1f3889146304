#include "process/time_limit.h"

#include <condition_variable>
#include <stop_token>
#include <utility>

#include "base/mutex.h"

namespace affskel::server {

TimeLimit::TimeLimit(std::chrono::milliseconds limit, std::function<void()> on_late)
    : thread_([limit, on_late = std::move(on_late)](const std::stop_token& stop) {
        base::Mutex mutex;
        std::condition_variable_any ended;
        {
          base::MutexLock lock(mutex);
          ended.wait_for(lock, stop, limit, [] { return false; });
        }
        if (!stop.stop_requested()) on_late();
      }) {}

}  // namespace affskel::server
