#include "services/artifact_waiters.h"

#include <gtest/gtest.h>

#include <future>
#include <thread>
#include <vector>

namespace affskel::server {
namespace {

TEST(ArtifactWaitersTest, TheLastWhoGivesUpTakesTheTaskBack) {
  std::vector<std::int64_t> withdrawn;
  ArtifactWaiters waiters([&](std::int64_t task) {
    withdrawn.push_back(task);
    return true;
  });
  waiters.join(7);
  waiters.join(7);
  waiters.join(8);
  waiters.give_up(7);
  EXPECT_TRUE(withdrawn.empty());
  EXPECT_EQ(waiters.count(7), 1U);
  waiters.give_up(7);
  EXPECT_EQ(withdrawn, std::vector<std::int64_t>{7});
  waiters.leave(8);
  EXPECT_EQ(withdrawn.size(), 1U) << "it came, or is gone";
  waiters.give_up(8);
  EXPECT_EQ(withdrawn.size(), 1U);
}

TEST(ArtifactWaitersTest, WhoComesWhileATaskIsTakenBackWaitsForThat) {
  std::promise<void> begun, go_on;
  std::atomic<bool> gone = false;
  ArtifactWaiters waiters([&](std::int64_t) {
    begun.set_value();
    go_on.get_future().wait();
    gone = true;
    return true;
  });
  waiters.join(7);
  std::thread first([&] { waiters.give_up(7); });
  begun.get_future().wait();
  std::thread second([&] {
    waiters.join(7);
    EXPECT_TRUE(gone) << "only now can it see that the task is gone";
  });
  go_on.set_value();
  first.join();
  second.join();
  EXPECT_EQ(waiters.count(7), 1U);
}

TEST(ArtifactWaitersTest, AServerThatClosesLeavesTheTasks) {
  ArtifactWaiters waiters([](std::int64_t) {
    ADD_FAILURE();
    return true;
  });
  waiters.join(7);
  waiters.close();
  waiters.give_up(7);
  EXPECT_EQ(waiters.count(7), 0U);
}

// On a full disk, say.  A caller that asks for the same meanwhile keeps it.
TEST(ArtifactWaitersTest, WhatCouldNotBeTakenBackIsTriedAgain) {
  bool works = false;
  std::vector<std::int64_t> withdrawn;
  ArtifactWaiters waiters([&](std::int64_t task) {
    if (works) withdrawn.push_back(task);
    return works;
  });
  for (const std::int64_t task : {7, 8, 9}) {
    waiters.join(task);
    waiters.give_up(task);
  }
  waiters.retry();
  EXPECT_TRUE(withdrawn.empty());
  waiters.join(8);
  works = true;
  waiters.retry();
  EXPECT_EQ(withdrawn, (std::vector<std::int64_t>{7, 9}));
  waiters.retry();
  EXPECT_EQ(withdrawn.size(), 2U) << "once";
  waiters.give_up(8);
  EXPECT_EQ(withdrawn.back(), 8);
}

}  // namespace
}  // namespace affskel::server
