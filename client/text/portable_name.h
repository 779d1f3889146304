#pragma once

#include <string>

namespace affskel::client {

/// The name of a job as the name of a file that every system can save: UTF-8, at most 100 bytes, no character
/// that Windows forbids, not empty, no dot first.
std::string portable_name(const std::string& job);

}  // namespace affskel::client
