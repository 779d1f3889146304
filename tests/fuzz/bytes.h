#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace affskel::fuzz {

/// An input, read as choices: past its end all are 0.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : left_(bytes) {}

  bool empty() const { return left_.empty(); }

  std::uint8_t byte() { return left_.empty() ? std::uint8_t{0} : static_cast<std::uint8_t>(take(1).front()); }

  /// @param bound 1 .. 256. @return 0 .. bound - 1.
  unsigned below(unsigned bound) { return byte() % bound; }
  /// Two bytes' worth, for more than 256 choices.
  std::size_t below_many(std::size_t bound) {
    const std::size_t high = byte();
    return (high << 8 | byte()) % bound;
  }

  /// As many as are there, `count` at most.
  std::string_view take(std::size_t count) {
    const std::string_view taken = left_.substr(0, count);
    left_.remove_prefix(taken.size());
    return taken;
  }

  std::string_view rest() { return take(left_.size()); }

 private:
  std::string_view left_;
};

}  // namespace affskel::fuzz
