#include "process/log_format.h"

#include <spdlog/pattern_formatter.h>

namespace affskel::server {
namespace {

/// The message, as the flag %* of a pattern.
class OneLine final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& entry, const std::tm&, spdlog::memory_buf_t& to) override {
    for (const char c : entry.payload) {
      const auto byte = static_cast<unsigned char>(c);
      to.push_back(byte < 0x20 || byte == 0x7F ? '?' : c);
    }
  }
  std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<OneLine>(); }
};

}  // namespace

std::unique_ptr<spdlog::formatter> log_formatter() {
  auto formatter = std::make_unique<spdlog::pattern_formatter>(spdlog::pattern_time_type::utc);
  formatter->add_flag<OneLine>('*').set_pattern("%Y-%m-%dT%H:%M:%S.%eZ level=%l %*");
  return formatter;
}

}  // namespace affskel::server
