#include "job/task_limit.h"

#include <ctime>
#include <string>
#include <utility>

namespace affskel::worker {

std::chrono::nanoseconds processor_time() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

TaskLimit::TaskLimit(core::ExecutionContext& task, std::chrono::seconds limit, const LimitedWork& work,
                     Clock clock)
    : task_(task), limit_(limit), work_(work), clock_(std::move(clock)), start_(clock_()) {}

bool TaskLimit::stop_requested() {
  return task_.stop_requested() || exceeded();
}

core::CoreError TaskLimit::reason(const core::CoreError& error) {
  if (error.code() != core::CoreError::Code::kCancelled || task_.stop_requested() || !exceeded())
    return error;
  return {core::CoreError::Code::kLimit,
          std::string(work_.what) + " takes more than " + std::to_string(limit_.count()) +
              " s of processor time, the limit of this worker (" + work_.option + "): " + work_.cause};
}

}  // namespace affskel::worker
