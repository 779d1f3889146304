#include "client/view/base64.h"

#include <gtest/gtest.h>

namespace affskel::client {
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

}  // namespace
}  // namespace affskel::client
