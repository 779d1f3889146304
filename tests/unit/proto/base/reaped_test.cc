#include "base/reaped.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <optional>

namespace affskel::base {
namespace {

TEST(Reaped, TellsHowAChildEndedAndLeavesNothingOfIt) {
  const pid_t child = fork();
  if (child == 0) _exit(3);
  const std::optional<int> status = reaped(child).get();
  ASSERT_TRUE(status && WIFEXITED(*status));
  EXPECT_EQ(WEXITSTATUS(*status), 3);
  EXPECT_EQ(waitpid(child, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
  EXPECT_EQ(reaped(child).get(), std::nullopt) << "it has been reaped";
}

}  // namespace
}  // namespace affskel::base
