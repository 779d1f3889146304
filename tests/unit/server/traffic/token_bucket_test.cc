#include "traffic/token_bucket.h"

#include <gtest/gtest.h>

namespace affskel::server {
namespace {

using std::chrono::milliseconds;

TEST(TokenBucketTest, WhatIsTakenTooSoonIsWaitedFor) {
  TokenBucket::Time now{};
  TokenBucket bucket({.burst = 10, .per_s = 5}, now);
  EXPECT_EQ(bucket.taken(now), 0);
  EXPECT_EQ(bucket.take(10, now), milliseconds(0));
  EXPECT_EQ(bucket.take(1, now), milliseconds(200));
  EXPECT_EQ(bucket.take(5, now), milliseconds(1200)) << "after those before";
  now += milliseconds(1200);
  EXPECT_EQ(bucket.take(0, now), milliseconds(0));
  EXPECT_EQ(bucket.taken(now), 10);
}

TEST(TokenBucketTest, HoldsNoMoreThanABurst) {
  TokenBucket::Time now{};
  TokenBucket bucket({.burst = 10, .per_s = 5}, now);
  now += std::chrono::hours(1);
  EXPECT_EQ(bucket.take(12, now), milliseconds(400));
}

}  // namespace
}  // namespace affskel::server
