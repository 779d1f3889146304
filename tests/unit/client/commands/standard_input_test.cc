// What commands read from standard input.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "client/files/read/read_shape.h"
#include "client_fixture.h"
#include "core/shapes/shapes.h"
#include "core/text/off_file.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::client {
namespace {

class StandardInputTest : public ::testing::Test {
 protected:
  StandardInputTest() { tests::write_file(dir_ / "box.off", core::write_off(core::make_box(3, 2, 1))); }

  Outcome run(const std::vector<std::string>& arguments) { return run_client_in(dir_, arguments); }

  tests::TemporaryDirectory dir_;
};

// Standard input is that file while this lives.
class StandardInput {
 public:
  explicit StandardInput(const std::string& file) : before_(dup(STDIN_FILENO)) {
    const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    dup2(fd, STDIN_FILENO);
    close(fd);
  }
  ~StandardInput() {
    dup2(before_, STDIN_FILENO);
    close(before_);
  }
  StandardInput(const StandardInput&) = delete;
  StandardInput& operator=(const StandardInput&) = delete;

 private:
  int before_;
};

TEST_F(StandardInputTest, AMinusSignIsStandardInput) {
  const auto run_on_box = [&](const std::vector<std::string>& arguments) {
    const StandardInput input(dir_ / "box.off");
    return run(arguments);
  };
  const std::vector<std::vector<std::string>> commands = {
      {"transform", "-", "-o", dir_ / "t.off", "--scale", "2"},
      {"perturb", "-", "-o", dir_ / "p.off", "--sigma", "0.01"},
      {"repair", "-", "-o", dir_ / "r.off"},
      {"compare", "-", dir_ / "box.off"},
      {"compare", dir_ / "box.off", "-"}};
  for (const std::vector<std::string>& command : commands) {
    const Outcome done = run_on_box(command);
    EXPECT_EQ(done.exit_code, 0) << command[0] << ": " << done.err;
  }
  EXPECT_EQ(read_shape(dir_ / "t.off").mesh().points[0], 2.0 * read_shape(dir_ / "box.off").mesh().points[0]);
  const Outcome twice = run_on_box({"compare", "-", "-"});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_NE(twice.err.find("only one of A, B and --solid"), std::string::npos) << twice.err;
}

}  // namespace
}  // namespace affskel::client
