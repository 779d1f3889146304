#include "link/retry_policy.h"

#include <gtest/gtest.h>

#include <set>

namespace affskel::worker {
namespace {

using std::chrono::milliseconds;
using Verdict = RetryPolicy::Verdict;

constexpr milliseconds kPatience{60000};

TEST(Backoff, DoublesUpToTheLongestAndStaysInItsUpperHalf) {
  Backoff backoff(milliseconds(20), milliseconds(1000), 1);
  for (const int most : {20, 40, 80, 160, 320, 640, 1000, 1000, 1000}) {
    const milliseconds pause = backoff.next();
    EXPECT_LE(pause.count(), most);
    EXPECT_GE(pause.count(), most / 2);
  }
  backoff.reset();
  EXPECT_LE(backoff.next().count(), 20);
}

TEST(Backoff, DiffersFromSeedToSeed) {
  std::set<std::int64_t> pauses;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    pauses.insert(Backoff(milliseconds(1000), milliseconds(1000), seed).next().count());
  }
  EXPECT_GT(pauses.size(), 10U);
}

// When a call is given up that always ends so, if the calls themselves take no time.
struct End {
  Verdict verdict;
  milliseconds at;
  int calls;
};

End call_until(grpc::StatusCode code, milliseconds longest, bool connected = false) {
  RetryPolicy policy(kPatience, 7);
  End end{Verdict::kAgain, milliseconds(0), 0};
  while (end.at < longest) {
    const RetryPolicy::Decision decision = policy.after(code, end.at, connected);
    ++end.calls;
    end.verdict = decision.verdict;
    if (decision.verdict != Verdict::kAgain) break;
    end.at += decision.pause;
  }
  return end;
}

TEST(RetryPolicy, AServerThatIsAwayIsWaitedForAsLongAsPatienceLasts) {
  for (const auto code :
       {grpc::StatusCode::UNAVAILABLE, grpc::StatusCode::CANCELLED, grpc::StatusCode::DEADLINE_EXCEEDED}) {
    const End end = call_until(code, milliseconds(600000));
    EXPECT_EQ(end.verdict, Verdict::kServerGone);
    EXPECT_GT(end.at, kPatience - milliseconds(1000));
    EXPECT_LE(end.at, kPatience);
    EXPECT_LT(end.calls, 150) << "about one a second";
  }
}

TEST(RetryPolicy, AFullServerIsWaitedForWithoutEnd) {
  EXPECT_EQ(call_until(grpc::StatusCode::RESOURCE_EXHAUSTED, milliseconds(3600000)).verdict, Verdict::kAgain);
}

TEST(RetryPolicy, AServerThatSaysItselfThatItCannotAnswerIsWaitedForWithoutEnd) {
  for (const auto code : {grpc::StatusCode::UNAVAILABLE, grpc::StatusCode::CANCELLED}) {
    EXPECT_EQ(call_until(code, milliseconds(3600000), true).verdict, Verdict::kAgain);
  }
  EXPECT_EQ(call_until(grpc::StatusCode::DEADLINE_EXCEEDED, milliseconds(3600000), true).verdict,
            Verdict::kServerGone)
      << "a connection that stands and says nothing is no answer";
}

TEST(RetryPolicy, TroubleOfTheServerFailsTheTaskOnlyAfterHalfAMinute) {
  for (const auto code : {grpc::StatusCode::INTERNAL, grpc::StatusCode::UNKNOWN}) {
    const End end = call_until(code, milliseconds(600000));
    EXPECT_EQ(end.verdict, Verdict::kFailed);
    EXPECT_GT(end.at, RetryPolicy::kTrouble - milliseconds(1000));
    EXPECT_LE(end.at, RetryPolicy::kTrouble);
  }
}

TEST(RetryPolicy, PatienceBeginsAnewWithEveryAnswer) {
  RetryPolicy policy(kPatience, 7);
  EXPECT_EQ(policy.after(grpc::StatusCode::RESOURCE_EXHAUSTED, milliseconds(500000), false).verdict,
            Verdict::kAgain);
  EXPECT_EQ(policy.after(grpc::StatusCode::UNAVAILABLE, milliseconds(530000), false).verdict,
            Verdict::kAgain);
  EXPECT_EQ(policy.after(grpc::StatusCode::UNAVAILABLE, milliseconds(560001), false).verdict,
            Verdict::kServerGone);
}

// A call that streams for minutes over a slow line, and breaks.
TEST(RetryPolicy, PatienceBeginsWhereTheServerWasLastHeard) {
  RetryPolicy policy(kPatience, 7);
  policy.heard(milliseconds(500000));
  EXPECT_EQ(policy.after(grpc::StatusCode::UNAVAILABLE, milliseconds(510000), false).verdict,
            Verdict::kAgain);
  EXPECT_EQ(policy.after(grpc::StatusCode::UNAVAILABLE, milliseconds(560001), false).verdict,
            Verdict::kServerGone);
}

TEST(RetryPolicy, WhatCannotSucceedIsNotTriedAgain) {
  EXPECT_EQ(call_until(grpc::StatusCode::ABORTED, kPatience).verdict, Verdict::kLeaseLost);
  EXPECT_EQ(call_until(grpc::StatusCode::NOT_FOUND, kPatience).verdict, Verdict::kLeaseLost);
  EXPECT_EQ(call_until(grpc::StatusCode::DATA_LOSS, kPatience).verdict, Verdict::kLeaseLost);
  for (const auto code : {grpc::StatusCode::INVALID_ARGUMENT, grpc::StatusCode::UNIMPLEMENTED,
                          grpc::StatusCode::FAILED_PRECONDITION}) {
    const End end = call_until(code, kPatience);
    EXPECT_EQ(end.verdict, Verdict::kFailed);
    EXPECT_EQ(end.calls, 1);
  }
}

}  // namespace
}  // namespace affskel::worker
