#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace affskel::client {

/// The bytes in base64 (RFC 4648, section 4, padded), without line breaks.
std::string base64(std::string_view bytes);

/// The bytes that padded base64 stands for, of several texts one after the other if there are; blanks and
/// line breaks anywhere.  Nothing when it is not base64.
std::optional<std::string> bytes_of_base64(std::string_view text);

}  // namespace affskel::client
