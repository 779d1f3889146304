#pragma once

#include <grpcpp/support/status.h>

#include <exception>
#include <utility>

#include "database/sqlite.h"
#include "traffic/call_ended.h"

namespace affskel::server {

/// The one place where errors become gRPC statuses.  Internal errors are logged.
grpc::Status status_of(const std::exception_ptr& error);

/// Tells the log what the database did.
void log_error(const SqliteError& error);

/// Its name: "NOT_FOUND".
const char* code_name(grpc::StatusCode code);

/// Runs the body of a call; OK unless it throws.
template <typename Body>
grpc::Status guarded(Body&& body) {
  try {
    std::forward<Body>(body)();
    return grpc::Status::OK;
  } catch (...) {
    return status_of(std::current_exception());
  }
}

}  // namespace affskel::server
