#include "closed_queue.h"

#include <gtest/gtest.h>

#include <cmath>

namespace affskel::load {
namespace {

TEST(ClosedQueue, OneCallerNeverWaits) {
  const ClosedQueueResult result = simulate_closed_queue({0.25}, {.callers = 1, .think = 0.75});
  EXPECT_NEAR(result.calls_per_second, 1, 0.01);
  EXPECT_NEAR(result.utilisation, 0.25, 0.01);
  EXPECT_NEAR(result.response_p99, 0.25, 1e-12);
}

// Beyond (think + service) / service callers the server is always busy, and all others wait in line.
TEST(ClosedQueue, ManyCallersWaitForAllButThoseWhoThink) {
  const ClosedQueueResult result = simulate_closed_queue({0.01}, {.callers = 500, .think = 1});
  EXPECT_NEAR(result.calls_per_second, 100, 0.5);
  EXPECT_NEAR(result.utilisation, 1, 1e-3);
  EXPECT_NEAR(result.response_median, 500 * 0.01 - 1, 0.02);
}

// Two callers and two service times, equally likely, without thinking: each waits for the other's, too.
TEST(ClosedQueue, DrawsEveryMeasuredTimeEquallyOften) {
  const ClosedQueueResult result =
      simulate_closed_queue({0.01, 0.03}, {.callers = 2, .think = 0, .duration = 2000});
  EXPECT_NEAR(result.calls_per_second, 1 / 0.02, 0.5);
  EXPECT_NEAR(result.response_median, 0.04, 1e-9);
  EXPECT_NEAR(result.response_p99, 0.06, 1e-9);
}

}  // namespace
}  // namespace affskel::load
