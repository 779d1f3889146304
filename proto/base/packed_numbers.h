#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "base/coding.h"

namespace affskel::base {

/// The number whose bytes are at `at`, the most significant first or last.
template <Codable Number>
Number decode_ordered(const char* at, bool big_endian) {
  if (!big_endian) return decode<Number>(at);
  std::array<char, sizeof(Number)> raw;
  std::reverse_copy(at, at + sizeof(Number), raw.begin());
  return decode<Number>(raw.data());
}

/// A type of numbers in files: their size, and how one becomes a double.
struct NumberKind {
  std::size_t bytes;
  double (*decode)(const char* at, bool big_endian);
};

template <Codable Number>
inline constexpr NumberKind kNumberKind{sizeof(Number), [](const char* at, bool big_endian) {
                                          return static_cast<double>(decode_ordered<Number>(at, big_endian));
                                        }};

/// Numbers of one kind as they stand in a file, decoded one by one as they are asked for: they take no more memory than
/// their bytes, and none where these are seen in the file's.
class PackedNumbers {
 public:
  PackedNumbers() = default;
  /// @param bytes outlive this; a rest that makes no number is left out.
  PackedNumbers(std::string_view bytes, const NumberKind& kind, bool big_endian = false)
      : data_(bytes.data()), size_(bytes.size() / kind.bytes), kind_(kind), big_endian_(big_endian) {}
  PackedNumbers(std::string&& bytes, const NumberKind& kind, bool big_endian = false)
      : PackedNumbers(std::make_shared<const std::string>(std::move(bytes)), kind, big_endian) {}

  std::size_t size() const { return size_; }
  double operator[](std::size_t i) const { return kind_.decode(data_ + i * kind_.bytes, big_endian_); }

 private:
  PackedNumbers(std::shared_ptr<const std::string> bytes, const NumberKind& kind, bool big_endian)
      : PackedNumbers(std::string_view(*bytes), kind, big_endian) {
    owned_ = std::move(bytes);
  }

  std::shared_ptr<const std::string> owned_;
  const char* data_ = nullptr;
  std::size_t size_ = 0;
  NumberKind kind_ = kNumberKind<double>;
  bool big_endian_ = false;
};

}  // namespace affskel::base
