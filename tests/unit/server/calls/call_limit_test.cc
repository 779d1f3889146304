#include "calls/call_limit.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "calls/limits.h"
#include "calls/status.h"

namespace affskel::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(CallLimitsTest, AlwaysLeaveDescriptorsToWorkersAndTheDatabase) {
  for (const std::uint64_t open_files : {16U, 64U, 256U, 1024U, 4096U, 1048576U, 0xFFFFFFFFU}) {
    const CallLimits limits = limits_for(open_files);
    EXPECT_GE(limits.downloads, 1U) << open_files;
    EXPECT_LE(limits.downloads, 256U) << open_files;
    EXPECT_GE(limits.inputs, 1U) << open_files;
    EXPECT_GE(limits.connections, 1U) << open_files;
    EXPECT_GE(limits.scrapes, 1U) << open_files;
    EXPECT_LE(limits.scrapes, 192U) << open_files;
    // Connections take three, downloads and inputs two each, and one in 32 is left beyond them and the scrapes.
    EXPECT_LE(3 * limits.connections + 2 * (limits.downloads + limits.inputs) + limits.scrapes +
                  std::min<std::uint64_t>(32, open_files / 32),
              open_files + 3)
        << open_files;
  }
}

/// A time that tests move.
struct Now {
  base::Pace::Time time = std::chrono::steady_clock::now();
  void pass(milliseconds duration) { time += duration; }
};

/// A second passes, in which so many bytes come.
void receive_in_a_second(std::uint64_t bytes, base::Pace& pace, Now& now) {
  now.pass(seconds(1));
  pace.moved(bytes, now.time);
  pace.turn(now.time);
}

TEST(PaceTest, TheFirstMessageHasItsTime) {
  Now now;
  base::Pace pace;
  EXPECT_FALSE(pace.late(now.time)) << "nobody waits for it";
  pace.turn(now.time);
  now.pass(milliseconds(9999));
  EXPECT_FALSE(pace.late(now.time));
  now.pass(milliseconds(1));
  EXPECT_TRUE(pace.late(now.time));
}

TEST(PaceTest, AByteASecondIsTooSlow) {
  Now now;
  base::Pace pace;
  pace.turn(now.time);
  for (int second = 0; second < 19; ++second) {
    receive_in_a_second(1, pace, now);
    EXPECT_FALSE(pace.late(now.time)) << second;
  }
  now.pass(seconds(1));
  EXPECT_TRUE(pace.late(now.time));
}

TEST(PaceTest, WhoKeepsTheRateIsNeverLate) {
  Now now;
  base::Pace pace;
  pace.turn(now.time);
  for (int second = 0; second < 1000; ++second) {
    receive_in_a_second(1100, pace, now);
    ASSERT_FALSE(pace.late(now.time)) << second;
  }
  EXPECT_EQ(pace.total(), 1100000U);
}

TEST(PaceTest, WhatWasFastOnceMustStayFast) {
  Now now;
  base::Pace pace;
  pace.turn(now.time);
  pace.moved(std::uint64_t{1} << 30, now.time);
  pace.turn(now.time);
  now.pass(seconds(10));
  pace.moved(1, now.time);
  pace.turn(now.time);
  now.pass(milliseconds(19999));
  EXPECT_FALSE(pace.late(now.time));
  now.pass(milliseconds(1));
  EXPECT_TRUE(pace.late(now.time)) << "a whole window without anything";
  pace.moved(1, now.time);
  pace.turn(now.time);
  now.pass(seconds(19));
  pace.moved(1, now.time);
  pace.turn(now.time);
  EXPECT_FALSE(pace.late(now.time));
  now.pass(seconds(1));
  EXPECT_TRUE(pace.late(now.time)) << "a whole window with next to nothing";
}

TEST(PaceTest, TheServersOwnTimeIsNotThePeers) {
  Now now;
  base::Pace pace;
  pace.turn(now.time);
  pace.moved(1, now.time);
  now.pass(seconds(3600));
  EXPECT_FALSE(pace.late(now.time));
  EXPECT_FALSE(pace.slow(now.time));
  pace.turn(now.time);
  now.pass(milliseconds(999));
  EXPECT_FALSE(pace.slow(now.time));
  now.pass(milliseconds(1));
  EXPECT_TRUE(pace.slow(now.time));
}

/// A call that notes how it was ended.
struct FakeCall final : Endable {
  void end(const grpc::Status& status) override { ended = status; }
  grpc::Status ended;
};

class CallLimitTest : public testing::Test {
 protected:
  CallLimitOptions options(std::size_t most, bool paced = true) {
    CallLimitOptions options;
    options.what = "uploads";
    options.most = most;
    if (paced) options.pace = base::PaceOptions{};
    options.now = [this] { return now_.time; };
    return options;
  }

  struct Entered {
    std::shared_ptr<FakeCall> call = std::make_shared<FakeCall>();
    CallLimit::Place place;
  };

  /// A call that waits for its peer.
  static Entered enter(CallLimit& limit, const Caller& caller) {
    Entered entered;
    entered.place = limit.enter(caller, entered.call);
    entered.place.turn();
    return entered;
  }

  static grpc::Status refusal(CallLimit& limit, const Caller& caller) {
    return guarded([&] { enter(limit, caller); });
  }

  Now now_;
};

TEST_F(CallLimitTest, RefusesMoreAndNamesTheLimit) {
  CallLimit limit(options(2));
  const Entered first = enter(limit, {1, "a"});
  {
    const Entered second = enter(limit, {2, "a"});
    const grpc::Status refused = refusal(limit, {3, "a"});
    EXPECT_EQ(refused.error_code(), grpc::StatusCode::UNAVAILABLE);
    EXPECT_NE(refused.error_message().find("2 uploads"), std::string::npos) << refused.error_message();
  }
  EXPECT_TRUE(refusal(limit, {3, "a"}).ok()) << "a place that was left is free";
}

TEST_F(CallLimitTest, SlowOnesEndAtOnceWhenOthersNeedTheirPlaces) {
  CallLimit limit(options(3));
  std::vector<Entered> slow;
  for (std::uint64_t i = 0; i < 3; ++i) slow.push_back(enter(limit, {i, "a"}));
  now_.pass(seconds(2));
  slow[0].place.moved(1 << 20);
  slow[0].place.turn();
  slow[1].place.moved(2);
  slow[1].place.turn();
  slow[2].place.moved(1);
  slow[2].place.turn();
  const Entered honest = enter(limit, {7, "a"});
  EXPECT_EQ(slow[2].call->ended.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_TRUE(slow[1].call->ended.ok());
  const Entered another = enter(limit, {8, "a"});
  EXPECT_FALSE(slow[1].call->ended.ok());
  EXPECT_TRUE(slow[0].call->ended.ok());
  EXPECT_FALSE(refusal(limit, {9, "a"}).ok()) << "who is fast keeps its place";
  slow[2].place.leave();
  EXPECT_EQ(limit.used(), 3U) << "who lost its place leaves no other";
}

TEST_F(CallLimitTest, SlowOnesEndByThemselves) {
  CallLimit limit(options(300));
  std::vector<Entered> slow;
  for (std::uint64_t i = 0; i < 200; ++i) slow.push_back(enter(limit, {i, "a"}));
  for (int second = 0; second < 20; ++second) {
    now_.pass(seconds(1));
    limit.tick();
    for (Entered& call : slow) {
      call.place.moved(1);
      call.place.turn();
    }
  }
  const Entered late_comer = enter(limit, {500, "a"});
  limit.tick();
  for (const Entered& call : slow) EXPECT_FALSE(call.call->ended.ok());
  EXPECT_TRUE(late_comer.call->ended.ok());
  EXPECT_EQ(limit.used(), 1U);
}

TEST_F(CallLimitTest, OnePeerMayHaveAllButGivesWayToAnother) {
  CallLimit limit(options(8, false));
  std::vector<Entered> all;
  for (std::uint64_t i = 0; i < 8; ++i) all.push_back(enter(limit, {i, "a"}));
  EXPECT_FALSE(refusal(limit, {8, "a"}).ok());
  std::vector<Entered> others;
  for (std::uint64_t i = 0; i < 4; ++i) others.push_back(enter(limit, {20 + i, "b"}));
  std::size_t ended = 0;
  for (const Entered& call : all) ended += call.call->ended.ok() ? 0 : 1;
  EXPECT_EQ(ended, 4U);
  EXPECT_FALSE(refusal(limit, {30, "b"}).ok()) << "half is its share";
  EXPECT_FALSE(refusal(limit, {30, "a"}).ok());
}

TEST_F(CallLimitTest, OneConnectionGivesWayToAnother) {
  CallLimit limit(options(16, false));
  std::vector<Entered> all;
  for (int i = 0; i < 16; ++i) all.push_back(enter(limit, {1, "a"}));
  EXPECT_FALSE(refusal(limit, {1, "a"}).ok());
  const Entered first = enter(limit, {2, "a"});
  const Entered second = enter(limit, {2, "a"});
  EXPECT_FALSE(refusal(limit, {2, "a"}).ok()) << "an eighth is its share";
  EXPECT_EQ(all.front().call->ended.error_code(), grpc::StatusCode::UNAVAILABLE);
}

TEST_F(CallLimitTest, WhoWorksIsNotEnded) {
  CallLimit limit(options(2));
  std::vector<Entered> working;
  for (std::uint64_t i = 0; i < 2; ++i) {
    working.push_back(enter(limit, {i, "a"}));
    working.back().place.moved(1);
  }
  now_.pass(seconds(100));
  limit.tick();
  EXPECT_FALSE(refusal(limit, {1, "b"}).ok());
  for (const Entered& call : working) EXPECT_TRUE(call.call->ended.ok());
}

TEST_F(CallLimitTest, HalfForAPeerWhereThatIsTheRule) {
  CallLimitOptions rule = options(4, false);
  rule.half_for_a_peer = true;
  rule.refusal = grpc::StatusCode::RESOURCE_EXHAUSTED;
  CallLimit limit(rule);
  const Entered first = enter(limit, {1, "a"}), second = enter(limit, {2, "a"});
  const grpc::Status refused = refusal(limit, {3, "a"});
  EXPECT_EQ(refused.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_NE(refused.error_message().find("2 uploads of yours"), std::string::npos) << refused.error_message();
  EXPECT_TRUE(refusal(limit, {3, "b"}).ok());
}

/// What enter_later has answered.
struct Answer {
  bool given = false;
  grpc::Status status;
  CallLimit::Place place;
  CallLimit::Granted taker() {
    return [this](const grpc::Status& how, CallLimit::Place what) {
      given = true;
      status = how;
      place = std::move(what);
    };
  }
};

TEST_F(CallLimitTest, TurnsComeInOrderAndPatienceEnds) {
  CallLimitOptions patient = options(1, false);
  patient.patience = milliseconds(5000);
  CallLimit limit(patient);
  Entered first = enter(limit, {1, "a"});
  const auto call = std::make_shared<FakeCall>();
  Answer second, third;
  limit.enter_later({2, "a"}, call, second.taker());
  limit.enter_later({3, "a"}, call, third.taker());
  EXPECT_FALSE(second.given);
  first.place.leave();
  EXPECT_TRUE(second.given);
  EXPECT_TRUE(second.status.ok());
  EXPECT_FALSE(third.given);
  now_.pass(milliseconds(4999));
  limit.tick();
  EXPECT_FALSE(third.given);
  now_.pass(milliseconds(1));
  limit.tick();
  EXPECT_EQ(third.status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_FALSE(third.place);
}

TEST_F(CallLimitTest, ClosingRefusesWhoComesAndWhoWaits) {
  CallLimitOptions patient = options(1, false);
  patient.patience = milliseconds(5000);
  CallLimit limit(patient);
  const Entered first = enter(limit, {1, "a"});
  const auto call = std::make_shared<FakeCall>();
  Answer second;
  limit.enter_later({2, "a"}, call, second.taker());
  const grpc::Status closing(grpc::StatusCode::UNAVAILABLE, "closing");
  limit.close(closing);
  EXPECT_EQ(second.status.error_message(), "closing");
  EXPECT_EQ(refusal(limit, {3, "b"}).error_message(), "closing");
  EXPECT_TRUE(first.call->ended.ok());
  limit.end_all(closing);
  EXPECT_FALSE(first.call->ended.ok());
}

TEST_F(CallLimitTest, MemoryIsTakenFromWhoHoldsMostForItsPace) {
  CallLimit limit(options(4));
  Entered large = enter(limit, {1, "a"}), fast = enter(limit, {2, "a"});
  large.place.moved(std::uint64_t{1} << 30);
  large.place.turn();
  // Its first window has passed; now it brings two thousand bytes a second.
  now_.pass(seconds(20));
  large.place.moved(1);
  fast.place.moved(std::uint64_t{1} << 30);
  EXPECT_FALSE(limit.relieve());
  large.place.turn();
  fast.place.turn();
  now_.pass(seconds(2));
  large.place.moved(4000);
  fast.place.moved(std::uint64_t{1} << 28);
  large.place.turn();
  fast.place.turn();
  EXPECT_TRUE(limit.relieve());
  EXPECT_FALSE(large.call->ended.ok());
  EXPECT_TRUE(fast.call->ended.ok());
  EXPECT_FALSE(limit.relieve());
}

}  // namespace
}  // namespace affskel::server
