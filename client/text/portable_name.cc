#include "client/text/portable_name.h"

#include <string_view>

#include "base/utf8.h"

namespace affskel::client {

std::string portable_name(const std::string& job) {
  constexpr std::size_t kMaxBytes = 100;
  std::string name(base::truncate_utf8(base::to_utf8(job), kMaxBytes));
  for (char& c : name) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f ||
        std::string_view("/\\:*?\"<>|").find(c) != std::string_view::npos)
      c = '_';
  }
  if (name.empty() || name.front() == '.') name.insert(0, "job");
  return name;
}

}  // namespace affskel::client
