#include "store/clock.h"

#include <gtest/gtest.h>

namespace affskel::server {
namespace {

// A suspended machine, a stopped process, a clock that jumps: to the workers' leases it is a moment.
TEST(SystemClockTest, TheLeaseClockCountsTheTimeInWhichItIsLookedAt) {
  std::int64_t monotonic = 1000;
  const SystemClock clock([&] { return monotonic; });
  const std::int64_t start = clock.lease_ms();
  monotonic += 400;
  EXPECT_EQ(clock.lease_ms(), start + 400);
  monotonic += 3'600'000;
  EXPECT_EQ(clock.lease_ms(), start + 400 + SystemClock::kLongestStepMs);
  monotonic -= 3'600'000;
  EXPECT_EQ(clock.lease_ms(), start + 400 + SystemClock::kLongestStepMs);
  monotonic += 250;
  EXPECT_EQ(clock.lease_ms(), start + 650 + SystemClock::kLongestStepMs);
}

}  // namespace
}  // namespace affskel::server
