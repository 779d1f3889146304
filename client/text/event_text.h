#pragma once

#include <string>

#include "affskel/v1/client_service.pb.h"

namespace affskel::client {

/// A line for each event of a job: time, event, task, worker and message; "..." and their number where events
/// were left out; then the workers that gave something to its field.
std::string event_lines(const v1::ListJobEventsResponse& response);

}  // namespace affskel::client
