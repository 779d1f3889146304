#include "client/web/sign_in_brake.h"

#include <gtest/gtest.h>

namespace affskel::client {
namespace {

using std::chrono::milliseconds;

class SignInBrakeTest : public ::testing::Test {
 protected:
  // Whether the token was looked at.
  bool shows(const std::string& peer, const std::string& token, bool is_right = false) {
    if (brake_.put_off(peer, token)) return false;
    if (is_right) {
      brake_.was_right(peer, token);
    } else {
      brake_.was_wrong(token);
    }
    return true;
  }

  // How many of so many guesses, each another and one in a millisecond, are looked at.
  unsigned guesses_seen(const std::string& peer, unsigned guesses) {
    unsigned seen = 0;
    for (unsigned i = 0; i < guesses; ++i) {
      seen += shows(peer, "guess " + std::to_string(guesses_++)) ? 1 : 0;
      now_ += milliseconds(1);
    }
    return seen;
  }

  SignInBrake::Clock::time_point now_{std::chrono::hours(1)};
  SignInBrake brake_{{}, [this] { return now_; }};
  unsigned guesses_ = 0;
};

TEST_F(SignInBrakeTest, GuessesAreHardlyEverSeen) {
  EXPECT_EQ(guesses_seen("a", 10000), BrakeLimits().free);
}

TEST_F(SignInBrakeTest, OneGuessOverAndOverIsHardlyEverSeen) {
  unsigned seen = 0;
  for (int i = 0; i < 60000; ++i) {
    seen += shows("a", "the same") ? 1 : 0;
    now_ += milliseconds(1);
  }
  EXPECT_LE(seen, BrakeLimits().free + 6);
}

TEST_F(SignInBrakeTest, GuessesThatComeAgainAreSeenMoreAndMoreSeldom) {
  guesses_seen("a", 100);
  for (int i = 0; i < 60; ++i) brake_.put_off("a", "patient " + std::to_string(i));
  now_ += milliseconds(1000);
  unsigned seen = 0;
  for (int i = 0; i < 20000; ++i) {
    for (int j = 0; j < 60; ++j) seen += shows("a", "patient " + std::to_string(j)) ? 1 : 0;
    now_ += milliseconds(1);
  }
  EXPECT_LE(seen, 14u);
}

TEST_F(SignInBrakeTest, TheRightTokenComesInBehindAnAddressThatGuesses) {
  guesses_seen("a", 1000);
  EXPECT_FALSE(shows("a", "right", true));
  EXPECT_EQ(guesses_seen("a", 1000), 0u);
  int waits = 0;
  while (const auto wait = brake_.put_off("a", "right")) {
    ASSERT_LE(++waits, 2);
    EXPECT_LE(*wait, BrakeLimits().longest);
    now_ += *wait;
  }
  brake_.was_right("a", "right");
  guesses_seen("a", 1000);
  EXPECT_TRUE(shows("a", "right", true)) << "at once, when it was right before";
}

TEST_F(SignInBrakeTest, OtherAddressesAreNotBrakedUntilTooManyGuess) {
  guesses_seen("a", 1000);
  EXPECT_TRUE(shows("b", "right", true));
  unsigned seen = 0;
  for (int i = 0; i < 200; ++i) seen += guesses_seen("address " + std::to_string(i), 1);
  EXPECT_LE(seen, BrakeLimits().free_in_all);
  EXPECT_FALSE(shows("c", "another", true)) << "all are braked";
  now_ += BrakeLimits().again;
  EXPECT_TRUE(shows("c", "another", true));
}

TEST_F(SignInBrakeTest, WhatIsRightOrCannotBeSeenDoesNotCount) {
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(shows("a", "right " + std::to_string(i), true));
    ASSERT_FALSE(brake_.put_off("a", "unseen"));
    brake_.was_not_seen("a");
  }
}

TEST_F(SignInBrakeTest, ForgetsInTime) {
  guesses_seen("a", 100);
  EXPECT_FALSE(shows("a", "one"));
  now_ += BrakeLimits().forget;
  EXPECT_TRUE(shows("a", "two"));
  EXPECT_FALSE(shows("a", "three"));
}

}  // namespace
}  // namespace affskel::client
