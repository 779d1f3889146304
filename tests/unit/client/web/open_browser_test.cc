#include "client/web/open_browser.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>

#include "test_environment.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::client {
namespace {

// With an xdg-open of our own, alone on the path.
class OpenBrowserTest : public ::testing::Test {
 protected:
  OpenBrowserTest() : path_(std::getenv("PATH")) { setenv("PATH", dir_.path().c_str(), 1); }
  ~OpenBrowserTest() override { setenv("PATH", path_.c_str(), 1); }

  bool open_by(const std::string& script) {
    tests::write_file(dir_ / "xdg-open", "#!/bin/sh\n" + script + "\n");
    chmod((dir_ / "xdg-open").c_str(), 0700);
    return open_browser("http://localhost:1/#key=k", dir_ / "page.html",
                        test_environment({{"DISPLAY", ":0"}}));
  }

  tests::TemporaryDirectory dir_;
  std::string path_;
};

TEST_F(OpenBrowserTest, KnowsWhenItFailed) {
  EXPECT_FALSE(open_by("exit 3"));
  EXPECT_TRUE(open_by("exit 0"));
}

TEST_F(OpenBrowserTest, GivesTheBrowserAFileThatLeadsThere) {
  EXPECT_TRUE(open_by("read line < \"$1\"; echo \"$line\" > '" + (dir_ / "seen") + "'"));
  EXPECT_NE(tests::read_file(dir_ / "seen").find("http://localhost:1/#key=k"), std::string::npos);
}

}  // namespace
}  // namespace affskel::client
