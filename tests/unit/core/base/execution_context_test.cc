#include "core/base/execution_context.h"

#include <gtest/gtest.h>

#include "core/stopping_context.h"

namespace affskel::core {
namespace {

TEST(ExecutionContext, NobodyStopsWhatHasNone) {
  EXPECT_NO_THROW(throw_if_stopped(nullptr));
  StopCheck check(nullptr);
  EXPECT_NO_THROW(check.did(std::uint64_t{1} << 40));
}

TEST(StopCheck, AsksOnceInManyStepsHoweverTheyAreCounted) {
  StoppingContext context;
  StopCheck check(&context);
  for (int i = 0; i < 1 << 20; ++i) check.did(1);
  EXPECT_EQ(context.asked(), 16U);
  for (int i = 0; i < 10; ++i) check.did(1 << 20);
  EXPECT_EQ(context.asked(), 26U);
}

TEST(StopCheck, ThrowsWhenItIsToStop) {
  StoppingContext context(1);
  StopCheck check(&context);
  check.did(1 << 16);
  EXPECT_THROW(check.did(1 << 16), CoreError);
}

}  // namespace
}  // namespace affskel::core
