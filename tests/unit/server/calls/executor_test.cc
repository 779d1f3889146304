#include "calls/executor.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <string>

namespace affskel::server {
namespace {

// Where something else would be a hang.
constexpr std::chrono::seconds kPatience{60};

TEST(ExecutorTest, CallersTakeTurns) {
  Executor executor({.threads = 1});
  std::promise<void> begun, go;
  executor.post(1, [&] {
    begun.set_value();
    go.get_future().wait();
  });
  begun.get_future().wait();
  std::string order;
  for (int i = 0; i < 4; ++i) executor.post(1, [&] { order += 'a'; });
  executor.post(2, [&] { order += 'b'; });
  executor.post(3, [&] { order += 'c'; });
  executor.post(2, [&] { order += 'b'; });
  go.set_value();
  executor.stop();
  EXPECT_EQ(order, "abcabaa");
}

TEST(ExecutorTest, RunsWhatWasPostedBeforeItStops) {
  int ran = 0;
  Executor executor({.threads = 1});
  for (int i = 0; i < 100; ++i) executor.post(1, [&] { ++ran; });
  executor.stop();
  EXPECT_EQ(ran, 100);
  executor.post(1, [&] { ++ran; });
  EXPECT_EQ(ran, 101) << "by the caller, when the threads have gone";
}

TEST(ExecutorTest, WhatIsDroppedDoesNotRun) {
  Executor executor({.threads = 1});
  std::promise<void> begun, go;
  const std::uint64_t running = executor.post(1, [&] {
    begun.set_value();
    go.get_future().wait();
  });
  begun.get_future().wait();
  EXPECT_FALSE(executor.drop(1, running)) << "it has begun";
  std::string order;
  executor.post(1, [&] { order += 'a'; });
  const std::uint64_t second = executor.post(1, [&] { order += 'b'; });
  const std::uint64_t only = executor.post(2, [&] { order += 'c'; });
  EXPECT_EQ(executor.waiting(), 3u);
  EXPECT_TRUE(executor.drop(1, second));
  EXPECT_TRUE(executor.drop(2, only));
  EXPECT_FALSE(executor.drop(2, only));
  EXPECT_EQ(executor.waiting(), 1u);
  go.set_value();
  executor.stop();
  EXPECT_EQ(order, "a");
}

TEST(ExecutorTest, CallersHaveShares) {
  Executor executor({.threads = 1, .calls = 4});
  std::promise<void> begun, go;
  executor.post(1, [&] {
    begun.set_value();
    go.get_future().wait();
  });
  begun.get_future().wait();
  for (int i = 0; i < 3; ++i) executor.post(1, [] {});
  EXPECT_TRUE(executor.has_room(1));
  executor.post(2, [] {});
  EXPECT_FALSE(executor.has_room(1)) << "three of four, and there are two callers";
  EXPECT_TRUE(executor.has_room(2));
  EXPECT_TRUE(executor.has_room(3));
  go.set_value();
}

TEST(ExecutorTest, ASlowCallerDoesNotHoldUpOthers) {
  Executor executor({.threads = 2});
  std::promise<void> go, done;
  executor.post(1, [&] { go.get_future().wait(); });
  executor.post(2, [&] { done.set_value(); });
  EXPECT_EQ(done.get_future().wait_for(kPatience), std::future_status::ready);
  go.set_value();
}

}  // namespace
}  // namespace affskel::server
