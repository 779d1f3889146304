#include "client/text/key_line.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
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

std::string place_in_box(const std::vector<double>& place, double size) {
  std::string text;
  for (const double value : place) {
    const double digits = 7 + std::floor(std::log10(std::fabs(value))) - std::floor(std::log10(size));
    text += text.empty() ? "" : " ";
    text += digits >= 1 ? base::plain(value, static_cast<int>(std::min(digits, 17.0))) : "0";
  }
  return text;
}

}  // namespace affskel::client
