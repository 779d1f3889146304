#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace affskel::base {

/// The text in small letters.
inline std::string lower_case(std::string_view text) {
  std::string made(text);
  std::transform(made.begin(), made.end(), made.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return made;
}

}  // namespace affskel::base
