#pragma once

#include <string>
#include <string_view>

namespace affskel::client {

/// The text as it stands in XML and HTML, between tags or as the value of an attribute; well-formed UTF-8.
std::string markup_text(std::string_view text);

}  // namespace affskel::client
