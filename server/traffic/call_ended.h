#pragma once

#include <grpcpp/support/status.h>

#include <exception>
#include <utility>

namespace affskel::server {

/// Thrown to end a call with a status of its own.
struct CallEnded : std::exception {
  explicit CallEnded(grpc::Status with) : status(std::move(with)) {}
  grpc::Status status;
};

}  // namespace affskel::server
