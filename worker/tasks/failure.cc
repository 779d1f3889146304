#include "tasks/failure.h"

#include <new>

#include "core/base/error.h"
#include "core/lattice/lattice_memory.h"
#include "job/available_memory.h"

namespace affskel::worker {
namespace {

v1::JobError describe(const core::CoreError& error) {
  v1::JobError message;
  switch (error.code()) {
    case core::CoreError::Code::kBadInput:
      message.set_code("BAD_INPUT");
      break;
    case core::CoreError::Code::kLimit:
      message.set_code("LIMIT");
      break;
    default:
      message.set_code("INTERNAL");
  }
  message.set_message(error.what());
  message.set_line(error.line());
  return message;
}

}  // namespace

Failure describe(const std::exception_ptr& problem, const v1::WorkerIdentity& worker) {
  Failure failure;
  try {
    std::rethrow_exception(problem);
  } catch (const core::LatticeMemoryError& error) {
    failure.error = describe(error);
    // Less than it has usually: others take memory just now.
    failure.retryable = error.bytes() <= worker.memory();
    if (!failure.retryable) failure.memory_needed = error.bytes();
  } catch (const core::CoreError& error) {
    failure.error = describe(error);
  } catch (const std::bad_alloc&) {
    failure.retryable = true;
    failure.error.set_code("LIMIT");
    const std::uint64_t left = available_memory() / 1000000;
    failure.error.set_message("not enough memory on worker " + worker.host() +
                              (left > 0 ? ", which has " + std::to_string(left) + " MB available" : "") +
                              "; take a wider spacing or a worker with more");
  } catch (const std::exception& error) {
    failure.error.set_code("INTERNAL");
    failure.error.set_message(error.what());
    failure.retryable = true;
  }
  return failure;
}

}  // namespace affskel::worker
