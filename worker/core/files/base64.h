#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace affskel::core {

/// The bytes in base64 (RFC 4648, section 4, padded), without line breaks.
std::string base64(std::string_view bytes);

/// The bytes that padded base64 stands for.  Blanks and line breaks may stand anywhere, and several padded
/// texts may follow each other.  Nothing when it is not base64.
std::optional<std::string> bytes_of_base64(std::string_view text);

}  // namespace affskel::core
