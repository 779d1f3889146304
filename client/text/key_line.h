#pragma once

#include <string>
#include <vector>

namespace affskel::client {

/// One `key: value` line with the values in one column.
std::string key_line(const std::string& key, const std::string& value);

/// Coordinates in a box whose longest side is `size`, to a millionth of that: 0.4 where rounding has left
/// 0.40000000000000036, and 0 where it has left less.
std::string place_in_box(const std::vector<double>& place, double size);

}  // namespace affskel::client
