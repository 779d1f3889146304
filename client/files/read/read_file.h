#pragma once

#include <cstdint>
#include <string>

#include "client/base/error.h"

namespace affskel::client {

/// Largest file that is read at all.
inline constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 31;

/// Error for a file whose content does not fit into the memory.
ClientError out_of_memory(const std::string& path);

/// The bytes of a regular file, of a pipe or of a device.
/// @throws ClientError kBadInput when it cannot be read, kLimit when it has more than `max_bytes`
/// or than the memory holds.
std::string read_file(const std::string& path, std::uint64_t max_bytes = kMaxFileBytes);

/// The same of standard input, to its end.  @param name of it in messages.
/// @throws ClientError the same, and kUsage when it is closed.
std::string read_standard_input(const std::string& name, std::uint64_t max_bytes = kMaxFileBytes);

}  // namespace affskel::client
