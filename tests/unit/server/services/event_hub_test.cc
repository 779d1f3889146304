#include "services/event_hub.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <vector>

namespace affskel::server {
namespace {

class EventHubTest : public testing::Test {
 protected:
  EventHubTest() {
    hub_.start(
        [this](const std::string& id) {
          if (failures_ > 0) {
            --failures_;
            throw std::bad_alloc();
          }
          v1::Job job;
          job.set_id(id);
          return id == "deleted" ? nullptr : std::make_shared<const v1::Job>(job);
        },
        [this] { note("work"); });
  }
  ~EventHubTest() override { hub_.stop(); }

  EventHub::Subscription subscribe(const std::string& id, bool at_once = false) {
    return hub_.subscribe(
        id, [this](const EventHub::JobPtr& job) { note(job == nullptr ? "none" : job->id()); }, at_once);
  }

  void change(const std::string& id, bool work = false) {
    Changes changes;
    changes.jobs.insert(id);
    changes.work = work;
    hub_.on_change(changes);
  }

  void note(const std::string& what) {
    {
      const std::lock_guard lock(mutex_);
      heard_.push_back(what);
    }
    changed_.notify_all();
  }

  /// What was heard, as soon as it is this much.
  std::vector<std::string> wait_for(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return heard_.size() >= count; });
    return heard_;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> heard_;
  std::atomic<int> failures_ = 0;
  EventHub hub_;
};

TEST_F(EventHubTest, TellsOnlyTheSubscribersOfAJob) {
  const EventHub::Subscription first = subscribe("first");
  change("second");
  change("first");
  EXPECT_EQ(wait_for(1), (std::vector<std::string>{"first"}));
}

TEST_F(EventHubTest, TellsTheStateAtOnceWhenAsked) {
  const EventHub::Subscription first = subscribe("first", true);
  EXPECT_EQ(wait_for(1), (std::vector<std::string>{"first"}));
}

TEST_F(EventHubTest, TellsOfDeletion) {
  const EventHub::Subscription gone = subscribe("deleted");
  change("deleted");
  EXPECT_EQ(wait_for(1), (std::vector<std::string>{"none"}));
}

TEST_F(EventHubTest, TellsOfWork) {
  change("first", true);
  EXPECT_EQ(wait_for(1), (std::vector<std::string>{"work"}));
}

// The last change of a job must not be the one that is not told.
TEST_F(EventHubTest, WhatCouldNotBeReadIsToldLater) {
  const EventHub::Subscription first = subscribe("first"), second = subscribe("second");
  failures_ = 3;
  change("first");
  const std::vector<std::string> heard = wait_for(2);  // all is told again
  EXPECT_NE(std::find(heard.begin(), heard.end(), "first"), heard.end());
}

TEST_F(EventHubTest, EndedSubscriptionsHearNothing) {
  { const EventHub::Subscription ended = subscribe("first"); }
  const EventHub::Subscription moved = [&] { return subscribe("second"); }();
  change("first");
  change("second");
  EXPECT_EQ(wait_for(1), (std::vector<std::string>{"second"}));
}

}  // namespace
}  // namespace affskel::server
