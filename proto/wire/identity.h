#pragma once

#include <string>

namespace affskel::wire {

/// A new name for a job, a lease or a worker: 128 random bits as 32 hexadecimal digits.
/// @throws std::runtime_error when the system has no random numbers.
std::string random_id();

/// The name of this machine.  A server tells the workers beside it by theirs, so both must ask here.
std::string host_name();

}  // namespace affskel::wire
