// Changes of many threads at once: those that come together are committed together, and each fails for
// itself.
#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>
#include <vector>

#include "database/errors.h"
#include "expect_store_error.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

constexpr int kThreads = 12, kRounds = 25;

/// Counts the changes that were begun on a thread which had not asked for them.
class WatchingClock final : public Clock {
 public:
  explicit WatchingClock(const Clock& clock) : clock_(clock) {}

  std::int64_t wall_ms() const override {  // once for each change, on the thread that commits it
    if (begun_++ > 0) ++for_others_;
    ++runs_;
    return clock_.wall_ms();
  }
  std::int64_t lease_ms() const override { return clock_.lease_ms(); }

  static void expect_one() { begun_ = 0; }
  int for_others() const { return for_others_; }
  int runs() const { return runs_; }

 private:
  const Clock& clock_;
  mutable std::atomic<int> for_others_ = 0, runs_ = 0;
  inline static thread_local int begun_ = 0;
};

class CommitTest : public StoreTest {
 protected:
  /// Every thread submits, and asks for what cannot be in between: once what is refused at once, and once what is refused
  /// after a part of it was written.
  void submit_from_all_threads(Store& store, const v1::Lease& block) {
    std::vector<std::thread> threads;
    for (int thread = 0; thread < kThreads; ++thread) {
      threads.emplace_back([this, &store, &block, thread] {
        for (int round = 0; round < kRounds; ++round) {
          const std::string mesh = "OFF " + std::to_string(thread) + "." + std::to_string(round);
          WatchingClock::expect_one();
          EXPECT_EQ(store.submit(submit_header(mesh, mesh), mesh).job.name(), mesh);
          if (round % 5 == 0) EXPECT_STORE_ERROR(store.renew("no token"), kFenced);
          if (round % 5 == 2) EXPECT_STORE_ERROR(report(block, 0, 1, true), kInvalid);
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
  }

  static std::multiset<std::string> names(Store& store) {
    ListFilter filter;
    filter.limit = 2 * kThreads * kRounds;
    std::multiset<std::string> names;
    for (const v1::Job& job : store.list(filter).jobs) names.insert(job.name());
    return names;
  }
};

TEST_F(CommitTest, EachChangeIsMadeOnceWhateverBecomesOfThoseBesideIt) {
  std::multiset<std::string> expected;
  for (int thread = 0; thread < kThreads; ++thread) {
    for (int round = 0; round < kRounds; ++round) {
      expected.insert("OFF " + std::to_string(thread) + "." + std::to_string(round));
    }
  }
  submit("OFF eroding", "eroding");
  expected.insert("eroding");
  prepare(4, 16);
  const v1::Lease block = lease();
  const WatchingClock clock(clock_);
  store_.reset();
  store_ = std::make_unique<Store>(database(), options_, clock);
  const int before = clock.runs();
  submit_from_all_threads(*store_, block);
  EXPECT_EQ(clock.runs() - before, kThreads * (kRounds + 2 * kRounds / 5)) << "some were made again";
  EXPECT_EQ(store_->job(block.job().id()).directions_done(), 0U);
  EXPECT_EQ(names(*store_), expected);
  EXPECT_GT(clock.for_others(), 0) << "nothing was committed together";
  store_ = std::make_unique<Store>(database(), options_, clock_);
  EXPECT_EQ(names(*store_), expected) << "what was acknowledged is on the disk";
}

TEST_F(CommitTest, RefusedWorkersDoNotKeepOthersFromTheirLeases) {
  submit("OFF 1");
  submit("OFF 2");
  v1::WorkerIdentity nameless = worker_identity("");
  const v1::WorkerIdentity a = worker_identity("a"), b = worker_identity("b");
  const std::vector<Store::LeaseAnswer> answers =
      store_->lease_all({{a, "", false, {}}, {nameless, "", false, {}}, {b, "", false, {}}});
  ASSERT_EQ(answers.size(), 3u);
  ASSERT_TRUE(answers[0].lease && answers[2].lease);
  EXPECT_NE(answers[0].lease->job().id(), answers[2].lease->job().id());
  EXPECT_FALSE(answers[1].lease);
  EXPECT_STORE_ERROR(std::rethrow_exception(answers[1].refused), kInvalid);
}

}  // namespace
}  // namespace affskel::server
