// The client with standard streams closed, and with signals ignored: what only a process of its own shows.
#include <gtest/gtest.h>

#include "lab.h"

namespace affskel::integration {
namespace {

class StreamsTest : public testing::Test {
 protected:
  // A line for the shell, where `c` is the client.
  Output shell(const std::string& line) const {
    return lab_.run({"/bin/sh", "-c",
                     std::string("c() { '") + AFFSKEL_CLIENT_BINARY + "' --server '" + lab_.address() +
                         "' \"$@\"; }; " + line});
  }

  void expect_closed(const std::string& line, const std::string& stream) const {
    const Output output = shell(line);
    EXPECT_EQ(output.exit_code, 2) << line;
    EXPECT_EQ(output.err, "error: " + stream + ": is closed\n") << line;
  }

  Lab lab_;
};

TEST_F(StreamsTest, AClosedStreamIsToldAsOne) {
  lab_.make_torus(100);
  expect_closed("c inspect - <&-", "stdin");
  expect_closed("c man >&-", "standard output");
  expect_closed("c inspect '" + lab_.path("m.off") + "' >&-", "standard output");
  expect_closed("c make box --size 1,1,1 -o - >&-", "standard output");
}

}  // namespace
}  // namespace affskel::integration
