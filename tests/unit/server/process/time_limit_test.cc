#include "process/time_limit.h"

#include <gtest/gtest.h>

#include <future>

namespace affskel::server {
namespace {

TEST(TimeLimitTest, TellsOfWhatIsLate) {
  std::promise<void> late;
  const TimeLimit limit(std::chrono::milliseconds(1), [&] { late.set_value(); });
  EXPECT_EQ(late.get_future().wait_for(std::chrono::seconds(60)), std::future_status::ready);
}

TEST(TimeLimitTest, IsSilentAndOverAtOnceInTime) {
  bool late = false;
  {
    const TimeLimit limit(std::chrono::hours(1), [&] { late = true; });
  }
  EXPECT_FALSE(late);
}

}  // namespace
}  // namespace affskel::server
