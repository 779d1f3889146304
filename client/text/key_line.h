#pragma once

#include <string>

namespace affskel::client {

/// One `key: value` line with the values in one column.
std::string key_line(const std::string& key, const std::string& value);

}  // namespace affskel::client
