#include "job/available_memory.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "tools/temporary_directory.h"

namespace affskel::worker {
namespace {

namespace fs = std::filesystem;

// A file system's root with the files of the kernel that a test writes.
class AvailableMemoryTest : public testing::Test {
 protected:
  AvailableMemoryTest() {
    write("proc/meminfo", "MemTotal:       16000 kB\nMemFree:         1000 kB\nMemAvailable:    8000 kB\n");
  }

  void write(const std::string& path, const std::string& text) {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }

  void group(const std::string& path, const std::string& limit, const std::string& use,
             const std::string& stat = "") {
    write("sys/fs/cgroup/" + path + "/memory.max", limit + "\n");
    write("sys/fs/cgroup/" + path + "/memory.current", use + "\n");
    if (!stat.empty()) write("sys/fs/cgroup/" + path + "/memory.stat", stat);
  }

  const tests::TemporaryDirectory directory_;
  const fs::path root_ = directory_.path();
};

TEST_F(AvailableMemoryTest, IsTheMachinesWhereNothingElseBindsIt) {
  EXPECT_EQ(available_memory(root_), 8000U * 1024);
  write("proc/self/limits",
        "Limit  Soft Limit Hard Limit Units\nMax address space  unlimited unlimited bytes\n");
  write("proc/self/cgroup", "0::/a/b\n");
  group("a/b", "max", "5000");
  EXPECT_EQ(available_memory(root_), 8000U * 1024);
}

TEST_F(AvailableMemoryTest, IsUnknownWithoutProc) {
  EXPECT_EQ(available_memory(root_ / "nothing"), 0U);
}

TEST_F(AvailableMemoryTest, IsWhatIsLeftOfTheAddressSpace) {
  write("proc/self/limits", "Max address space         5000000              unlimited            bytes\n");
  write("proc/self/status", "VmPeak:\t 9000 kB\nVmSize:\t 1000 kB\n");
  EXPECT_EQ(available_memory(root_), 5000000U - 1000 * 1024);
  write("proc/self/status", "VmSize:\t 9000 kB\n");
  EXPECT_EQ(available_memory(root_), 1U) << "0 would be no bound";
}

TEST_F(AvailableMemoryTest, IsWhatTheTightestGroupLeaves) {
  write("proc/self/cgroup", "0::/a/b/c\n");
  group("a", "700000", "100000");
  group("a/b", "max", "90000");
  group("a/b/c", "900000", "80000");
  EXPECT_EQ(available_memory(root_), 600000U);
  group("a/b/c", "500000", "400000", "anon 1\nactive_file 7\ninactive_file 150000\n");
  EXPECT_EQ(available_memory(root_), 250000U) << "idle pages of files are given up";
}

TEST_F(AvailableMemoryTest, FindsTheGroupOfAContainerAtTheMount) {
  write("proc/self/cgroup", "0::/docker/0123\n");
  group("", "300000", "100000");
  EXPECT_EQ(available_memory(root_), 200000U);
}

TEST_F(AvailableMemoryTest, KnowsGroupsOfVersion1) {
  write("proc/self/cgroup", "5:cpu,cpuacct:/x\n4:memory:/x/y\n0::/\n");
  const std::string mount = "sys/fs/cgroup/memory/";
  write(mount + "memory.limit_in_bytes", "9223372036854771712\n");
  write(mount + "memory.usage_in_bytes", "1000\n");
  write(mount + "x/y/memory.limit_in_bytes", "400000\n");
  write(mount + "x/y/memory.usage_in_bytes", "300000\n");
  write(mount + "x/y/memory.stat", "inactive_file 1\ntotal_inactive_file 50000\n");
  EXPECT_EQ(available_memory(root_), 150000U);
}

TEST(AvailableMemory, IsKnownHere) {
  EXPECT_GT(available_memory(), 1U << 20);
}

}  // namespace
}  // namespace affskel::worker
