#include "scheduling/bounds_exchange.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <map>

#include "wire/erosion_bound.h"
#include "wire/limits.h"

namespace affskel::server {
namespace {

wire::PointRecord record(std::uint32_t point, double erosion) {
  return {erosion, 1.0, 7, point};
}

/// What a worker is told when it reports, by point.
std::map<std::uint64_t, double> told(BoundsExchange& exchange, const std::string& field,
                                     const std::string& worker,
                                     const std::vector<wire::PointRecord>& records = {},
                                     std::size_t room = wire::kUsualBoundsBytes) {
  v1::ReportResponse response;
  exchange.exchange(field, worker, records, room, response);
  std::map<std::uint64_t, double> bounds;
  for (const v1::ErosionBounds& message : response.bounds()) {
    EXPECT_EQ(message.step_size(), message.bound_size());
    std::uint64_t point = 0;
    for (int i = 0; i < message.step_size(); ++i) {
      point += message.step(i);
      bounds[point] = wire::bound_value(message.bound(i));
    }
  }
  return bounds;
}

TEST(ErosionBound, IsNeverBelowAndHardlyAbove) {
  for (double e : {0.0, 1.0, 1.0 / 3, 69717072563.5, 5e-324, 1e-300, 1e300}) {
    const double bound = wire::bound_value(wire::bound_above(e));
    EXPECT_GE(bound, e);
    if (e > 1e-307) {
      EXPECT_LE(bound, e * (1 + 1e-6));
    }
  }
  EXPECT_EQ(wire::bound_value(wire::bound_above(1.0)), 1.0) << "short numbers arrive as they are";
  EXPECT_EQ(wire::bound_value(wire::bound_above(std::numeric_limits<double>::max())),
            std::numeric_limits<double>::infinity());
}

TEST(BoundsExchange, TellsEachWorkerWhatTheOthersReportedSince) {
  BoundsExchange exchange;
  EXPECT_TRUE(told(exchange, "job", "a", {record(3, 2.0)}).empty());
  EXPECT_TRUE(told(exchange, "job", "b", {record(3, 1.5), record(70000, 4.0)}).empty()) << "its first report";
  EXPECT_EQ(told(exchange, "job", "a", {record(0, 8.0)}),
            (std::map<std::uint64_t, double>{{3, 1.5}, {70000, 4.0}}));
  EXPECT_TRUE(told(exchange, "job", "a").empty()) << "told already, and nothing of its own";
  EXPECT_EQ(told(exchange, "job", "b"), (std::map<std::uint64_t, double>{{0, 8.0}}));
}

TEST(BoundsExchange, WhoHasJoinedHearsWhatCameBeforeItsFirstReport) {
  BoundsExchange exchange;
  exchange.join("job", "a");
  EXPECT_TRUE(told(exchange, "job", "a", {record(1, 1.0)}).empty());
  EXPECT_EQ(exchange.kept(), 0U) << "alone";
  exchange.join("job", "b");
  EXPECT_TRUE(told(exchange, "job", "a", {record(3, 2.0)}).empty());
  exchange.join("job", "b");  // its next block
  EXPECT_EQ(told(exchange, "job", "b"), (std::map<std::uint64_t, double>{{3, 2.0}}));
}

TEST(BoundsExchange, KeepsJobsApart) {
  BoundsExchange exchange;
  for (const char* worker : {"a", "b"}) {
    told(exchange, "one", worker);
    told(exchange, "two", worker);
  }
  told(exchange, "one", "a", {record(1, 1.0)});
  EXPECT_TRUE(told(exchange, "two", "b").empty());
  EXPECT_EQ(told(exchange, "one", "b").size(), 1U);
}

// Thousands of small jobs beside a long one leave nothing behind, and the long one misses nothing.
TEST(BoundsExchange, ForgetsFinishedJobsAndNothingOfTheOthers) {
  BoundsExchange exchange;
  for (const char* worker : {"a", "b", "c"}) told(exchange, "long", worker);
  std::map<std::uint64_t, double> expected;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    told(exchange, "long", "a", {record(i, 1.0)});
    expected[i] = 1.0;
    const std::string job = "short " + std::to_string(i);
    for (const char* worker : {"a", "b"}) told(exchange, job, worker);
    for (const char* worker : {"a", "b"}) told(exchange, job, worker, {record(7, 2.0)});
    exchange.forget(job);
    if (i == 500) {
      EXPECT_EQ(told(exchange, "long", "b"), expected);
    }
  }
  EXPECT_EQ(exchange.kept(), 1000U);
  EXPECT_EQ(told(exchange, "long", "c"), expected);
  EXPECT_EQ(told(exchange, "long", "b").size(), 499U);
  exchange.forget("long");
  EXPECT_EQ(exchange.kept(), 0U);
}

TEST(BoundsExchange, PassesNothingOnThatIsOutOfOrder) {
  BoundsExchange exchange;
  told(exchange, "job", "a");
  told(exchange, "job", "b");
  told(exchange, "job", "a", {record(2, 1.0), record(1, 1.0)});
  EXPECT_TRUE(told(exchange, "job", "b").empty());
}

TEST(BoundsExchange, SendsInAnswersOfLimitedSizeAndForgetsTheOldest) {
  BoundsExchangeOptions options;
  options.message_points = 10;
  options.kept_bytes = 3 * (512 + 80);
  BoundsExchange exchange(options);
  told(exchange, "job", "a");
  told(exchange, "job", "b");
  std::vector<wire::PointRecord> records;
  for (std::uint32_t p = 0; p < 40; ++p) records.push_back(record(p, 1 + p));
  told(exchange, "job", "a", records);
  constexpr std::size_t kTwoMessages = 2 * 54;
  const auto first = told(exchange, "job", "b", {}, kTwoMessages);
  const auto second = told(exchange, "job", "b", {}, kTwoMessages);
  EXPECT_EQ(first.size(), 20U);
  EXPECT_EQ(first.begin()->first, 10U) << "the first ten are forgotten";
  EXPECT_EQ(second.size(), 10U);
  EXPECT_EQ(second.rbegin()->first, 39U);
  EXPECT_TRUE(told(exchange, "job", "b").empty());
}

TEST(BoundsExchange, AnswersFitWhatTheirWorkersTake) {
  for (const std::uint32_t room : {wire::kUsualBoundsBytes, std::uint32_t{8} << 20}) {
    BoundsExchange exchange;
    v1::ReportResponse first, ignored;
    exchange.exchange("job", "a", {}, room, ignored);
    exchange.exchange("job", "b", {}, room, ignored);
    std::vector<wire::PointRecord> records;
    for (std::uint32_t p = 0; p < 2'000'000; ++p) records.push_back(record(p * 2000, 1.0));
    exchange.exchange("job", "a", records, room, ignored);
    exchange.exchange("job", "b", {}, room, first);
    EXPECT_GT(first.ByteSizeLong(), room - (room >> 2));
    EXPECT_LE(first.ByteSizeLong(), room + 4096);
  }
  EXPECT_LT(wire::kUsualBoundsBytes + 4096, std::uint32_t{4} << 20) << "gRPC's own limit";
}

TEST(BoundsExchange, RemembersTheWorkersOfSoManyFields) {
  BoundsExchangeOptions options;
  options.fields = 2;
  BoundsExchange exchange(options);
  for (const char* job : {"one", "two", "three"}) {
    told(exchange, job, "a");
    told(exchange, job, "b");
  }
  told(exchange, "three", "a", {record(1, 1.0)});
  EXPECT_EQ(told(exchange, "three", "b").size(), 1U);
  EXPECT_TRUE(told(exchange, "one", "a", {record(1, 1.0)}).empty());
}

TEST(BoundsExchange, RemembersSoManyWorkersOfAField) {
  BoundsExchangeOptions options;
  options.workers = 2;
  BoundsExchange exchange(options);
  for (const char* worker : {"a", "b", "c"}) exchange.join("field", worker);
  EXPECT_TRUE(told(exchange, "field", "c", {record(1, 1.0)}).empty());
  EXPECT_EQ(exchange.kept(), 0U) << "the others are forgotten, and it is alone";
}

}  // namespace
}  // namespace affskel::server
