#pragma once

#include <string>
#include <string_view>

#include "client/base/shape_file.h"

namespace affskel::client {

/// Reads the shape of a file, see core::parse_shape; "-" is standard input, whose path becomes "stdin".
/// @throws ClientError kBadInput with the line where there is one; kLimit when the file is too large.
ShapeFile read_shape(const std::string& path);

/// The same for bytes that came from `path`.
ShapeFile parse_shape(const std::string& path, std::string_view bytes);

}  // namespace affskel::client
