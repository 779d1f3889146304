#pragma once

#include <grpcpp/support/status.h>

#include <string>

#include "client/base/error.h"

namespace affskel::client {

/// Error for a failed call.
/// @param server the address, named when it cannot be reached
/// @param not_yet exit code when the job's state does not allow the call
ClientError error_from_status(const grpc::Status& status, const std::string& server,
                              ExitCode not_yet = ExitCode::kNotAllowed);

}  // namespace affskel::client
