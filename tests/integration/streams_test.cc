// What only processes of their own show: standard streams that are closed, files that may not grow.
#include <gtest/gtest.h>

#include <filesystem>

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

TEST_F(StreamsTest, AFileThatMayNotGrowIsALimitAndLeavesNothing) {
  lab_.make_torus(500);
  std::filesystem::create_directory(lab_.path("out"));
  const std::string limited = "ulimit -f 100; cd '" + lab_.path("out") + "'; ";
  for (const char* name : {"f.vti", "f.csv", "f.vtkhdf"}) {
    const Output computed =
        shell(limited + "'" + AFFSKEL_WORKER_BINARY + "' compute ../m.off --spacing 100 -o " + name);
    EXPECT_EQ(computed.exit_code, 8) << computed.err;
    EXPECT_NE(computed.err.find(name), std::string::npos) << computed.err;
  }
  const Process server = lab_.server({"--workers", "1"});
  const std::string job = lab_.submit({"--points", "100000"});
  ASSERT_EQ(lab_.follow_to_end(job).state(), v1::JOB_STATE_DONE);
  for (const char* name : {"f.vti", "f.csv", "f.vtkhdf", "f.hdf"}) {
    const Output fetched = shell(limited + "c fetch " + job + " field -o " + name);
    EXPECT_EQ(fetched.exit_code, 8) << name << fetched.err;
    EXPECT_NE(fetched.err.find(name), std::string::npos) << fetched.err;
  }
  EXPECT_TRUE(std::filesystem::is_empty(lab_.path("out")));
}

}  // namespace
}  // namespace affskel::integration
