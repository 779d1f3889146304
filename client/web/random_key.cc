#include "client/web/random_key.h"

#include <sys/random.h>

#include <array>

#include "client/base/error.h"

namespace affskel::client {

std::string random_key() {
  std::array<unsigned char, 32> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw error_from_errno(errno, "cannot get random bytes", "", ExitCode::kInternal);
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

}  // namespace affskel::client
