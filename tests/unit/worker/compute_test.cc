#include "compute.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "core/shapes/shapes.h"
#include "core/text/off_file.h"
#include "tools/temporary_directory.h"

namespace affskel::worker {
namespace {

TEST(ComputeTest, AnOutputThatCannotBeWrittenTellsWhy) {
  const tests::TemporaryDirectory directory;
  ComputeOptions options;
  options.file = directory / "box.off";
  options.spacing = 500;
  std::ofstream(options.file) << core::write_off(core::make_box(2000, 2000, 2000));
  const auto error_of = [&](const std::string& output) {
    options.output = output;
    try {
      compute(options);
    } catch (const std::system_error& error) {
      EXPECT_NE(std::string(error.what()).find(output), std::string::npos) << error.what();
      return error.code().value();
    }
    return 0;
  };
  std::filesystem::create_symlink("/dev/full", directory / "full.csv");
  EXPECT_EQ(error_of(directory / "full.csv"), ENOSPC);
  EXPECT_EQ(error_of(directory / "missing/field.csv"), ENOENT);
  EXPECT_EQ(error_of(directory / "field.csv"), 0);
  EXPECT_GT(std::filesystem::file_size(directory / "field.csv"), 0U);
  // Nothing stays behind of the attempts, and a file in place is replaced as a whole.
  const std::filesystem::path field = directory / "field.csv";
  std::ofstream(directory / "kept.csv") << "old";
  std::filesystem::create_symlink("kept.csv", directory / "link.csv");
  std::filesystem::permissions(directory / "kept.csv", std::filesystem::perms(0640));
  EXPECT_EQ(error_of(directory / "link.csv"), 0);
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "link.csv"));
  EXPECT_EQ(std::filesystem::file_size(directory / "kept.csv"), std::filesystem::file_size(field));
  EXPECT_EQ(std::filesystem::status(directory / "kept.csv").permissions(), std::filesystem::perms(0640));
  const std::vector<std::string> names = directory.names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()),
            (std::set<std::string>{"box.off", "field.csv", "full.csv", "kept.csv", "link.csv"}));
}

}  // namespace
}  // namespace affskel::worker
