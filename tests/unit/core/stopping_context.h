#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <limits>

#include "core/base/error.h"
#include "core/base/execution_context.h"

namespace affskel::core {

/// Lets a computation go on when asked the first `times` times, and stops it from then on.
class StoppingContext : public ExecutionContext {
 public:
  explicit StoppingContext(std::uint64_t times = std::numeric_limits<std::uint64_t>::max()) : times_(times) {}

  bool stop_requested() override { return asked_++ >= times_; }
  std::uint64_t asked() const { return asked_; }

 private:
  const std::uint64_t times_;
  std::atomic<std::uint64_t> asked_{0};
};

/// Expects `compute(ExecutionContext*)`, on one thread, to ask at least `least` times, and to end with
/// kCancelled, without asking again, at whichever of these times it is told to stop.
template <class Compute>
void expect_stops_wherever_it_is_asked(std::uint64_t least, Compute compute) {
  StoppingContext never;
  compute(&never);
  ASSERT_GE(never.asked(), least);
  const std::uint64_t step = never.asked() / 20 + 1;
  for (std::uint64_t times = 0; times < never.asked(); times += step) {
    StoppingContext context(times);
    try {
      compute(&context);
      ADD_FAILURE() << "went on after " << times << " of " << never.asked() << " questions";
    } catch (const CoreError& error) {
      EXPECT_EQ(error.code(), CoreError::Code::kCancelled) << error.what();
    }
    EXPECT_EQ(context.asked(), times + 1);
  }
}

}  // namespace affskel::core
