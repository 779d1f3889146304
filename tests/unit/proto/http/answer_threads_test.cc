#include "http/answer_threads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <string>
#include <vector>

namespace affskel::http {
namespace {

// Works that wait at a gate and then write down whose they are.
class AnswerThreadsTest : public ::testing::Test {
 protected:
  std::shared_ptr<AnswerThreads::Work> work(const std::string& whose) {
    const auto made = std::make_shared<AnswerThreads::Work>();
    made->whose = whose;
    made->run = [this, whose, stop = made->stop.get_token()] {
      std::unique_lock lock(mutex_);
      begun_.push_back(whose);
      changed_.notify_all();
      changed_.wait(lock, stop, [this] { return open_; });
      done_.push_back(stop.stop_requested() ? whose + " stopped" : whose);
      changed_.notify_all();
    };
    return made;
  }

  void open() {
    const std::lock_guard lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }

  std::vector<std::string> wait_for_begun(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return begun_.size() >= count; });
    return begun_;
  }

  std::vector<std::string> wait_for_done(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return done_.size() >= count; });
    return done_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::vector<std::string> begun_;
  bool open_ = false;
  std::vector<std::string> done_;
};

TEST_F(AnswerThreadsTest, WhoHasManyDelaysOnlyHimself) {
  AnswerThreads threads({1, 1}, 100, 100);
  ASSERT_TRUE(threads.add(work("loud")));
  wait_for_begun(1);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(threads.add(work("loud")));
  ASSERT_TRUE(threads.add(work("quiet")));
  ASSERT_TRUE(threads.add(work("quiet")));
  open();
  const std::vector<std::string> done = wait_for_done(8);
  EXPECT_EQ(done,
            (std::vector<std::string>{"loud", "quiet", "loud", "quiet", "loud", "loud", "loud", "loud"}));
}

TEST_F(AnswerThreadsTest, NobodyHasAllThreads) {
  AnswerThreads threads({2, 1}, 100, 100);
  ASSERT_TRUE(threads.add(work("loud")));
  ASSERT_TRUE(threads.add(work("loud")));
  ASSERT_TRUE(threads.add(work("quiet")));
  std::vector<std::string> begun = wait_for_begun(2);
  std::sort(begun.begin(), begun.end());
  EXPECT_EQ(begun, (std::vector<std::string>{"loud", "quiet"}));
  open();
  wait_for_done(3);
}

TEST_F(AnswerThreadsTest, TooManyAreRefusedAndThoseOfOneFirst) {
  AnswerThreads threads({1, 1}, 3, 2);
  EXPECT_TRUE(threads.add(work("a")));
  EXPECT_TRUE(threads.add(work("a")));
  EXPECT_FALSE(threads.add(work("a")));
  EXPECT_TRUE(threads.add(work("b")));
  EXPECT_FALSE(threads.add(work("c")));
  open();
  wait_for_done(3);
}

TEST_F(AnswerThreadsTest, WhatNobodyWaitsForIsForgottenOrStopped) {
  AnswerThreads threads({1, 1}, 2, 2);
  const auto first = work("a"), second = work("a");
  ASSERT_TRUE(threads.add(first));
  wait_for_begun(1);
  ASSERT_TRUE(threads.add(second));
  EXPECT_FALSE(threads.add(work("a")));
  threads.drop(second);
  ASSERT_TRUE(threads.add(work("b"))) << "its place is free";
  threads.drop(first);
  open();
  EXPECT_EQ(wait_for_done(2), (std::vector<std::string>{"a stopped", "b"}));
}

TEST_F(AnswerThreadsTest, TheEndStopsWhatIsUnderWayAndForgetsTheRest) {
  {
    AnswerThreads threads({1, 1}, 2, 2);
    ASSERT_TRUE(threads.add(work("a")));
    wait_for_begun(1);
    ASSERT_TRUE(threads.add(work("a")));
  }
  EXPECT_EQ(wait_for_done(1), (std::vector<std::string>{"a stopped"}));
}

}  // namespace
}  // namespace affskel::http
