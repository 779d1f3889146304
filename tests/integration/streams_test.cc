// What only processes of their own show: standard streams that are closed, files that may not grow.
#include <gtest/gtest.h>

#include <algorithm>
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

  // Of the server or the worker, which say who they are.
  void expect_failure(const std::string& line, int code, const std::string& said) const {
    const Output output = lab_.run({"/bin/sh", "-c", line});
    EXPECT_EQ(output.exit_code, code) << line;
    EXPECT_NE(output.err.find(said), std::string::npos) << line << output.err;
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

// The first file that it opens, the lock of its folder, must not become its standard output.
TEST_F(StreamsTest, AServersCommandsDoNothingWithAClosedStream) {
  const std::string server = std::string("'") + AFFSKEL_SERVER_BINARY + "' ";
  const std::string folder = " --data-dir '" + lab_.path("tokens") + "'";
  ASSERT_EQ(lab_.run({"/bin/sh", "-c", server + "token add --owner a" + folder}).exit_code, 0);
  const std::string lock = lab_.read("tokens/server.lock");
  const std::string copy = " -o '" + lab_.path("copy.db") + "'";
  for (const std::string& command :
       {"token add --owner b" + folder, "token list" + folder, "check" + folder, "backup" + folder + copy,
        "migrate" + folder, std::string("--version")}) {
    expect_failure(server + command + " >&-", 2, "standard output: is closed");
  }
  EXPECT_FALSE(std::filesystem::exists(lab_.path("copy.db")));
  EXPECT_EQ(lab_.read("tokens/server.lock"), lock);
  const Output list = lab_.run({"/bin/sh", "-c", server + "token list <&- 2>&-" + folder});
  EXPECT_EQ(std::count(list.out.begin(), list.out.end(), '\n'), 2) << list.out;
}

TEST_F(StreamsTest, OutputThatFindsNoRoomIsALimit) {
  for (const std::string program : {AFFSKEL_SERVER_BINARY, AFFSKEL_WORKER_BINARY, AFFSKEL_CLIENT_BINARY}) {
    for (const char* option : {" --help", " --version"}) {
      expect_failure("'" + program + "'" + option + " >/dev/full", 8,
                     "cannot write to standard output: No space left on device");
    }
  }
  expect_failure(std::string("'") + AFFSKEL_WORKER_BINARY + "' --version >&-", 2,
                 "standard output: is closed");
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
