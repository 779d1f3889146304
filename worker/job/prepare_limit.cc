#include "job/prepare_limit.h"

#include <ctime>
#include <string>
#include <utility>

namespace affskel::worker {

std::chrono::nanoseconds processor_time() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

PrepareLimit::PrepareLimit(core::ExecutionContext& task, std::chrono::seconds limit, Clock clock)
    : task_(task), limit_(limit), clock_(std::move(clock)), start_(clock_()) {}

bool PrepareLimit::stop_requested() {
  return task_.stop_requested() || exceeded();
}

core::CoreError PrepareLimit::reason(const core::CoreError& error) {
  if (error.code() != core::CoreError::Code::kCancelled || task_.stop_requested() || !exceeded())
    return error;
  return {
      core::CoreError::Code::kLimit,
      "making the mesh ready takes more than " + std::to_string(limit_.count()) +
          " s of processor time, the limit of this worker: very many surfaces or triangles lie on or across "
          "each other, or the lattice is very fine"};
}

}  // namespace affskel::worker
