#include "base/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <thread>
#include <vector>

#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::base {
namespace {

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
  const tests::TemporaryDirectory dir;
  {
    AtomicFile file(dir / "out.txt");
    file.write("hello ");
    EXPECT_FALSE(std::filesystem::exists(dir / "out.txt"));
    file.write("world");
    file.commit();
  }
  EXPECT_EQ(tests::read_file(dir / "out.txt"), "hello world");
  EXPECT_EQ(dir.names().size(), 1u);
}

TEST(AtomicFile, LeavesNothingBehindWithoutCommit) {
  const tests::TemporaryDirectory dir;
  {
    AtomicFile file(dir / "out.txt");
    file.write(std::string(3 << 20, 'x'));  // more than the buffer: the temporary file has content
  }
  EXPECT_TRUE(dir.names().empty());
}

TEST(AtomicFile, KeepsTheOldFileWithoutCommit) {
  const tests::TemporaryDirectory dir;
  tests::write_file(dir / "out.txt", "old");
  { AtomicFile(dir / "out.txt").write("new"); }
  EXPECT_EQ(tests::read_file(dir / "out.txt"), "old");
  EXPECT_EQ(dir.names().size(), 1u);
}

TEST(AtomicFile, KeepsModeAndFollowsLinks) {
  const tests::TemporaryDirectory dir;
  tests::write_file(dir / "real.txt", "old");
  chmod((dir / "real.txt").c_str(), 0640);
  std::filesystem::create_symlink("real.txt", dir / "link.txt");
  AtomicFile file(dir / "link.txt");
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(dir / "link.txt"));
  EXPECT_EQ(tests::read_file(dir / "real.txt"), "new");
  struct stat info {};
  stat((dir / "real.txt").c_str(), &info);
  EXPECT_EQ(info.st_mode & 07777, 0640u);
}

TEST(AtomicFile, DoesNotReplaceWhatThisUserMayNotWrite) {
  const tests::TemporaryDirectory dir;
  tests::write_file(dir / "out.txt", "old");
  chmod((dir / "out.txt").c_str(), 0444);
  chmod((dir / "").c_str(), 0777);
  const uid_t before = geteuid();
  ASSERT_EQ(before == 0 ? seteuid(65534) : 0, 0) << "root may write everything";
  try {
    AtomicFile file(dir / "out.txt");
    ADD_FAILURE() << "it would be replaced";
  } catch (const FileError& error) {
    EXPECT_EQ(error.code().value(), EACCES);
  }
  ASSERT_EQ(seteuid(before), 0);
  EXPECT_EQ(tests::read_file(dir / "out.txt"), "old");
  EXPECT_EQ(dir.names().size(), 1u);
}

// The process's own.
mode_t umask_now() {
  const mode_t mask = umask(0);
  umask(mask);
  return mask;
}

TEST(AtomicFile, NewFilesHaveTheUmaskWhichThreadsLeaveAlone) {
  const tests::TemporaryDirectory dir;
  const mode_t before = umask(027);
  std::atomic<int> other_modes = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&] {
      for (int round = 0; round < 200; ++round) {
        const AtomicFile file(dir / "out.txt");
        struct stat info {};
        stat(file.path().c_str(), &info);
        if ((info.st_mode & 07777) != 0640) ++other_modes;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(other_modes, 0);
  EXPECT_EQ(umask_now(), 027u);
  umask(before);
}

TEST(AtomicFile, FollowsLinksThatLeadNowhereYet) {
  const tests::TemporaryDirectory dir;
  std::filesystem::create_directory(dir / "sub");
  std::filesystem::create_symlink("sub/second", dir / "first");
  std::filesystem::create_symlink(dir / "real.txt", dir / "sub/second");
  AtomicFile file(dir / "first");
  file.write("new");
  file.commit();
  EXPECT_EQ(tests::read_file(dir / "real.txt"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(dir / "first"));
  EXPECT_TRUE(std::filesystem::is_symlink(dir / "sub/second"));
  std::filesystem::create_symlink("loop", dir / "loop");
  EXPECT_THROW(AtomicFile(dir / "loop"), FileError);
}

TEST(AtomicFile, LeavesDevicesWhatTheyAre) {
  AtomicFile file("/dev/null");
  file.write("gone");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

// What AtomicFiles in `action` write to the standard output.
template <typename Action>
std::string on_stdout(Action&& action) {
  ::testing::internal::CaptureStdout();
  action();
  return ::testing::internal::GetCapturedStdout();
}

TEST(AtomicFile, AMinusSignIsTheStandardOutput) {
  const std::string large(3 << 20, 'x');
  EXPECT_EQ(on_stdout([&] {
              AtomicFile file("-");
              file.write("hello ");
              file.write(large);
              file.commit();
            }),
            "hello " + large);
  EXPECT_FALSE(std::filesystem::exists("-"));
}

TEST(AtomicFile, TheStandardOutputGetsEverythingOrNothing) {
  std::filesystem::path temporary;
  EXPECT_EQ(on_stdout([&] {
              AtomicFile file("-");
              temporary = file.path();
              file.write(std::string(3 << 20, 'x'));
              EXPECT_TRUE(std::filesystem::exists(temporary));
            }),
            "")
      << "what was not committed";
  EXPECT_FALSE(std::filesystem::exists(temporary));
}

TEST(AtomicFile, LibrariesWriteForTheStandardOutputByPath) {
  EXPECT_EQ(on_stdout([&] {
              AtomicFile file("-");
              tests::write_file(file.path(), "by path");
              file.commit();
            }),
            "by path");
}

TEST(AtomicFile, WithoutAFolderForTemporaryFilesThereIsNoStandardOutput) {
  const char* const before = std::getenv("TMPDIR");
  const std::string old = before == nullptr ? "" : before;
  setenv("TMPDIR", "/nowhere/at/all", 1);
  EXPECT_THROW(AtomicFile("-"), FileError);
  before == nullptr ? unsetenv("TMPDIR") : setenv("TMPDIR", old.c_str(), 1);
}

TEST(AtomicFile, NamesTheTargetWhenItCannotBeWritten) {
  const tests::TemporaryDirectory dir;
  try {
    AtomicFile file(dir / "missing/out.txt");
    FAIL() << "a missing directory was accepted";
  } catch (const FileError& error) {
    EXPECT_EQ(error.code().value(), ENOENT);
    EXPECT_EQ(error.file(), dir / "missing/out.txt");
  }
  EXPECT_THROW(AtomicFile(dir.path()), FileError);
}

TEST(AtomicFile, TakesNamesAsLongAsTheFileSystemDoes) {
  const tests::TemporaryDirectory dir;
  const std::string longest(255, 'n');
  AtomicFile file(dir / longest);
  file.write("x");
  file.commit();
  EXPECT_EQ(dir.names(), (std::vector<std::string>{longest}));
  EXPECT_THROW(AtomicFile(dir / (longest + "n")), FileError) << "known at once, not when all is done";
  EXPECT_EQ(dir.names().size(), 1u);
}

TEST(AtomicFile, SyncDoesNotMakeTheFileAppear) {
  const tests::TemporaryDirectory dir;
  AtomicFile file(dir / "out.txt");
  file.write("hello");
  file.sync();
  EXPECT_FALSE(std::filesystem::exists(dir / "out.txt"));
  file.commit();
  EXPECT_EQ(tests::read_file(dir / "out.txt"), "hello");
}

TEST(AtomicFile, TellsOfAFullDisk) {
  AtomicFile file("/dev/full");
  file.write("x");
  try {
    file.commit();
    FAIL() << "a full disk was not noticed";
  } catch (const FileError& error) {
    EXPECT_EQ(error.code().value(), ENOSPC);
  }
}

}  // namespace
}  // namespace affskel::base
