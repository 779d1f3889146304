// The preloaded library in a program of every system.
#include <gtest/gtest.h>

#include <filesystem>

#include "catalogue.h"
#include "process.h"
#include "stage.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::chaos {
namespace {

class PreloadTest : public testing::Test {
 protected:
  PreloadTest() : control_(dir_ / "control") {}

  // What the shell's commands print.
  std::string shell(const std::string& script) {
    const std::string out = dir_ / "out";
    tests::write_file(out, "");
    run({{"/bin/sh", "-c", script},
         out,
         out,
         {std::string("LD_PRELOAD=") + AFFSKEL_CHAOS_PRELOAD, "AFFSKEL_CHAOS_CONTROL=" + control_.path()}},
        kPatience);
    return tests::read_file(out);
  }
  std::string file(const std::string& name) const { return dir_ / name; }

  tests::TemporaryDirectory dir_;
  ControlFile control_;
};

TEST_F(PreloadTest, ChangesNothingUnlessTold) {
  EXPECT_EQ(
      shell("dd if=/dev/zero of=" + file("a") + " bs=100 count=1 2>/dev/null && stat -c %s " + file("a")),
      "100\n");
  EXPECT_EQ((*control_).bites, 0U);
}

// Where most tools write, descriptors 0 to 2, calls never fail: these hold logs.
TEST_F(PreloadTest, WritesFail) {
  const std::string script =
      "LC_ALL=C perl -e 'open(F, \">\", \"" + file("a") + "\"); syswrite(F, \"xy\") or print $!'";
  for (const auto& [trouble, message] :
       {std::pair{kNoSpace, "No space"}, {kWriteError, "Input/output error"}, {kShortWrites, ""}}) {
    (*control_).trouble = trouble;
    (*control_).bites = 0;
    EXPECT_EQ(shell(script).substr(0, std::string(message).size()), message);
    EXPECT_GT((*control_).bites, 0U);
  }
  EXPECT_EQ(tests::read_file(file("a")), "x");
}

TEST_F(PreloadTest, SyncsFail) {
  (*control_).trouble = kSyncError;
  EXPECT_NE(
      shell("LC_ALL=C dd if=/dev/zero of=" + file("a") + " bs=100 count=1 conv=fsync").find("Input/output"),
      std::string::npos);
}

TEST_F(PreloadTest, FilesCannotBeOpenedForWriting) {
  (*control_).trouble = kReadOnly;
  EXPECT_NE(shell("LC_ALL=C dd if=/dev/zero of=" + file("a") + " bs=100 count=1").find("Read-only"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(file("a")));
}

TEST_F(PreloadTest, TheClockJumps) {
  const long before = std::stol(shell("date +%s"));
  (*control_).clock_shift_ns = -3'600'000'000'000;
  const long shifted = std::stol(shell("date +%s"));
  EXPECT_LT(shifted, before);
  EXPECT_GE(shifted, before - 3600);
}

}  // namespace
}  // namespace affskel::chaos
