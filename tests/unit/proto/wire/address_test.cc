#include "wire/address.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace affskel::wire {
namespace {

std::string refusal(const char* text) {
  try {
    parse_address(text);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(ParseAddress, ReadsBackWhatItWrites) {
  for (const char* text : {"unix:/run/s.sock", "unix:s.sock", "localhost:7060", "127.0.0.1:0", "[::1]:65535"})
    EXPECT_EQ(parse_address(text).target(), text);
}

TEST(ParseAddress, SaysWhatIsWrong) {
  for (const auto& [text, why] : {std::pair("http://localhost:7060", "that is a URL"),
                                  {"https://[::1]:7060", "that is a URL"},
                                  {"localhost", "no port"},
                                  {":7060", "no host"},
                                  {"::1:7060", "brackets"},
                                  {"localhost:65536", "0 .. 65535"},
                                  {"localhost:x", "0 .. 65535"},
                                  {"unix:", "path is empty"}}) {
    EXPECT_NE(refusal(text).find(why), std::string::npos) << text << ": " << refusal(text);
    EXPECT_NE(refusal(text).find("expected unix:PATH or HOST:PORT"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace affskel::wire
