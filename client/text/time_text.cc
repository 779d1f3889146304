#include "client/text/time_text.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>

namespace affskel::client {

std::string utc_time(std::uint64_t unix_ms) {
  if (unix_ms == 0) return "-";
  const auto seconds = static_cast<std::time_t>(unix_ms / 1000);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  std::array<char, 32> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S", &parts);
  std::array<char, 8> fraction{};
  std::snprintf(fraction.data(), fraction.size(), ".%03uZ", static_cast<unsigned>(unix_ms % 1000));
  return std::string(text.data(), length) + fraction.data();
}

std::string duration_text(std::chrono::milliseconds duration) {
  const auto ms = static_cast<unsigned long long>(std::max<std::int64_t>(0, duration.count()));
  const unsigned long long s = ms / 1000;
  std::array<char, 48> text{};
  if (s < 10) {
    std::snprintf(text.data(), text.size(), "%llu.%llu s", s, ms % 1000 / 100);
  } else if (s < 60) {
    std::snprintf(text.data(), text.size(), "%llu s", s);
  } else if (s < 3600) {
    std::snprintf(text.data(), text.size(), "%llu min %02llu s", s / 60, s % 60);
  } else if (s < 86400) {
    std::snprintf(text.data(), text.size(), "%llu h %02llu min", s / 3600, s % 3600 / 60);
  } else {
    std::snprintf(text.data(), text.size(), "%llu d %02llu h", s / 86400, s % 86400 / 3600);
  }
  return text.data();
}

std::string took_text(std::chrono::milliseconds duration) {
  const auto ms = static_cast<unsigned long long>(std::max<std::int64_t>(0, duration.count()));
  if (ms >= 60000) return duration_text(duration);
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%llu.%03llu s", ms / 1000, ms % 1000);
  return text.data();
}

std::uint64_t unix_now_ms() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
}

std::string age_text(std::uint64_t then_ms, std::uint64_t now_ms) {
  return duration_text(std::chrono::milliseconds(now_ms > then_ms ? now_ms - then_ms : 0));
}

}  // namespace affskel::client
