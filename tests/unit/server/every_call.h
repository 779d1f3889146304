#pragma once

#include <grpcpp/grpcpp.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace affskel::server {

/// Every call of both services, by its name: what it makes of a connection.
/// @param job id that the calls name, where they name one.
std::vector<std::pair<std::string, std::function<grpc::Status(const std::shared_ptr<grpc::Channel>&)>>>
every_call(const std::string& job);

}  // namespace affskel::server
