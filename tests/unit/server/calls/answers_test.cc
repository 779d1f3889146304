#include "calls/answers.h"

#include <gtest/gtest.h>

#include <map>

#include "calls/status.h"

namespace affskel::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

struct Call : Endable {
  void end(const grpc::Status& status) override { ended = status; }
  grpc::Status ended;
};

class AnswersTest : public testing::Test {
 protected:
  AnswersTest() {
    AnswerOptions options;
    options.of_connection = 100;
    options.of_all = 250;
    options.little = 10;
    options.pace = {.first = seconds(20), .window = seconds(20), .least_per_s = 10};
    options.now = [this] { return now_; };
    answers_ = std::make_unique<Answers>(options, [this](std::uint64_t connection) {
      return taken_.contains(connection) ? std::optional(taken_[connection]) : std::nullopt;
    });
  }
  static Caller caller(std::uint64_t connection) { return {.connection = connection, .peer = "a"}; }
  bool is_free(std::uint64_t connection) {
    return guarded([&] { answers_->check(caller(connection)); }).ok();
  }
  Answers::Answer enter(std::uint64_t connection, std::uint64_t bytes,
                        const std::shared_ptr<Call>& call = {}) {
    return answers_->enter(caller(connection), bytes, call);
  }
  void pass(seconds duration, std::uint64_t connection, std::uint64_t bytes_per_s) {
    for (milliseconds passed{}; passed < duration; passed += milliseconds(200)) {
      now_ += milliseconds(200);
      taken_[connection] += bytes_per_s / 5;
      answers_->tick();
    }
  }

  std::chrono::steady_clock::time_point now_ = std::chrono::steady_clock::now();
  std::map<std::uint64_t, std::uint64_t> taken_;
  std::unique_ptr<Answers> answers_;
};

TEST_F(AnswersTest, AConnectionLeavesOnlySoMuchUnread) {
  const Answers::Answer first = enter(1, 60);
  EXPECT_TRUE(is_free(1));
  {
    const Answers::Answer second = enter(1, 60);
    EXPECT_FALSE(is_free(1));
    EXPECT_TRUE(is_free(2));
    EXPECT_EQ(answers_->bytes(), 120u);
  }
  EXPECT_TRUE(is_free(1)) << "it has read one";
}

TEST_F(AnswersTest, TogetherTheyLeaveRoomToThoseWhoRead) {
  std::vector<Answers::Answer> unread;
  for (std::uint64_t connection = 1; connection <= 3; ++connection) unread.push_back(enter(connection, 90));
  EXPECT_FALSE(is_free(1)) << "270 of 250, and some of it its own";
  EXPECT_TRUE(is_free(4));
  for (std::uint64_t connection = 4; connection <= 6; ++connection) unread.push_back(enter(connection, 90));
  EXPECT_FALSE(is_free(7)) << "more than twice as much as there may be";
}

TEST_F(AnswersTest, WhoTakesNothingIsEnded) {
  taken_[1] = 1000;
  const auto call = std::make_shared<Call>();
  const Answers::Answer answer = enter(1, 60, call);
  pass(seconds(19), 1, 0);
  EXPECT_TRUE(call->ended.ok());
  pass(seconds(1), 1, 0);
  EXPECT_EQ(call->ended.error_code(), grpc::StatusCode::UNAVAILABLE);
}

TEST_F(AnswersTest, WhoTakesItsTimeIsNot) {
  taken_[1] = 0;
  const auto steady = std::make_shared<Call>(), slow = std::make_shared<Call>();
  {
    const Answers::Answer answer = enter(1, 5000, steady);
    pass(seconds(100), 1, 20);
    EXPECT_TRUE(steady->ended.ok());
  }
  const Answers::Answer answer = enter(2, 5000, slow);
  pass(seconds(40), 2, 5);
  EXPECT_EQ(slow->ended.error_code(), grpc::StatusCode::UNAVAILABLE) << "half of the least pace";
}

}  // namespace
}  // namespace affskel::server
