#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "base/file_error.h"

namespace affskel::base {

/// The bytes of a file, or of whatever else can be read to its end, as a pipe.
/// @param max_bytes of a larger one only these and one more are read.
/// @throws FileError with the action "cannot open" or "cannot read".
std::string read_file(const std::string& path,
                      std::uint64_t max_bytes = std::numeric_limits<std::uint64_t>::max() - 1);

}  // namespace affskel::base
