#pragma once

#include <grpcpp/channel.h>

#include <chrono>
#include <memory>

namespace affskel::client {

/// Asks once, by the gRPC health checking protocol (grpc.health.v1.Health, method Check), about the server as
/// a whole, which needs no token.
/// @param serving set when the status is OK: whether the answer was SERVING.
/// @return UNAVAILABLE or DEADLINE_EXCEEDED when no answer comes in time.
grpc::Status check_health(const std::shared_ptr<grpc::Channel>& channel, std::chrono::milliseconds deadline,
                          bool& serving);

}  // namespace affskel::client
