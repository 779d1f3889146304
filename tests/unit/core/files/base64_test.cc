#include "core/files/base64.h"

#include <gtest/gtest.h>

namespace affskel::core {
namespace {

TEST(Base64, VectorsOfTheStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(Base64, EveryByte) {
  EXPECT_EQ(base64(std::string("\x00\xFF\xFB\xEF\xBE", 5)), "AP/7774=");
}

TEST(Base64, BytesReadBack) {
  const std::string all = [] {
    std::string bytes;
    for (int i = 0; i < 256; ++i) bytes.push_back(static_cast<char>(i));
    return bytes;
  }();
  for (std::size_t length = 0; length <= all.size(); ++length) {
    EXPECT_EQ(bytes_of_base64(base64(all.substr(0, length))), all.substr(0, length));
  }
  EXPECT_EQ(bytes_of_base64(" Zg = =\n Zm8=\tZm9v"), "ffofoo");
}

TEST(Base64, RefusesWhatItIsNot) {
  for (const char* text : {"Z", "Zg", "Zg=", "Zg===", "Z===", "====", "Zg=a", "Zm9*", "Zm9\x80"}) {
    EXPECT_EQ(bytes_of_base64(text), std::nullopt) << text;
  }
}

}  // namespace
}  // namespace affskel::core
