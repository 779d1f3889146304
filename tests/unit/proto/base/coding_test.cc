#include "base/coding.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>

#include "wire/field_record.h"

namespace affskel::base {
namespace {

std::string hex(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    for (const int digit : {(c >> 4) & 15, c & 15}) text += "0123456789abcdef"[digit];
  }
  return text;
}

template <typename Number>
std::string bytes_of(Number value) {
  std::string bytes;
  append(bytes, value);
  return hex(bytes);
}

// IEEE 754 by hand: the same on any machine.
TEST(Coding, LeastSignificantByteFirst) {
  EXPECT_EQ(bytes_of(std::uint32_t{0x01020304}), "04030201");
  EXPECT_EQ(bytes_of(std::uint64_t{0x0102030405060708}), "0807060504030201");
  EXPECT_EQ(bytes_of(std::uint16_t{0x0102}), "0201");
  EXPECT_EQ(bytes_of(std::int8_t{-2}), "fe");
  EXPECT_EQ(bytes_of(std::int32_t{-2}), "feffffff");
  EXPECT_EQ(bytes_of(1.0), "000000000000f03f");
  EXPECT_EQ(bytes_of(-2.5f), "000020c0");
}

TEST(Coding, ReadsBack) {
  std::string bytes;
  append(bytes, -0.1);
  append(bytes, std::int16_t{-300});
  append(bytes, std::uint32_t{4000000000});
  EXPECT_EQ(decode<double>(bytes.data()), -0.1);
  EXPECT_EQ(decode<std::int16_t>(bytes.data() + 8), -300);
  EXPECT_EQ(decode<std::uint32_t>(bytes.data() + 10), 4000000000);
}

TEST(FieldRecord, IsEThenAreaThenDirection) {
  std::string bytes(wire::kPointRecordBytes, '\0');
  wire::encode_point_record(bytes.data(), {1.0, -2.5, 7, 0x01020304});
  EXPECT_EQ(hex(bytes),
            "000000000000f03f"
            "00000000000004c0"
            "07000000"
            "04030201");
  EXPECT_EQ(wire::decode_field_record(bytes.data()).direction, 7U);
  EXPECT_EQ(wire::decode_point_record(bytes.data()).point, 0x01020304U);
}

TEST(FieldRecord, IsEmptyUntilADirectionReachesIt) {
  const wire::FieldRecord empty;
  EXPECT_EQ(empty.erosion, std::numeric_limits<double>::infinity());
  EXPECT_EQ(empty.area, 0);
  EXPECT_EQ(empty.direction, wire::kNoDirection);
}

}  // namespace
}  // namespace affskel::base
