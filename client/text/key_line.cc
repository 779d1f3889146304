#include "client/text/key_line.h"

#include <algorithm>

#include "client/text/printable.h"

namespace affskel::client {
namespace {

constexpr std::size_t kKeyWidth = 22;

}  // namespace

std::string key_line(const std::string& key, const std::string& value) {
  const std::size_t pad = key.size() + 1 < kKeyWidth ? kKeyWidth - key.size() - 1 : 1;
  std::string safe = printable(value);
  std::replace(safe.begin(), safe.end(), '\n', ' ');
  return key + ":" + std::string(pad, ' ') + safe + "\n";
}

}  // namespace affskel::client
