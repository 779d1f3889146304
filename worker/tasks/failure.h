#pragma once

#include <cstdint>
#include <exception>

#include "affskel/v1/types.pb.h"
#include "affskel/v1/worker_service.pb.h"

namespace affskel::worker {

/// What a failed task tells the server.
struct Failure {
  v1::JobError error;
  bool retryable = false;
  std::uint64_t memory_needed = 0;  ///< bytes, when that is more than this worker ever has
};

/// @param worker this one: its host, and the memory that it has.
Failure describe(const std::exception_ptr& problem, const v1::WorkerIdentity& worker);

}  // namespace affskel::worker
