#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "expect_store_error.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

class ReportTest : public StoreTest {
 protected:
  // Bytes of the records that wait to be merged.
  std::int64_t logged() const {
    Database db(database(), Database::Mode::kReadOnly);
    return db.integer("SELECT sum(length(data)) FROM field_log").value_or(0);
  }
};

v1::PositionRange range(std::uint64_t begin, std::uint64_t end) {
  v1::PositionRange result;
  result.set_begin(begin);
  result.set_end(end);
  return result;
}

std::vector<std::pair<std::uint64_t, std::uint64_t>> done(const v1::Job& job) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> ranges;
  for (const v1::PositionRange& r : job.done_positions()) ranges.emplace_back(r.begin(), r.end());
  return ranges;
}

TEST_F(ReportTest, FieldOfAllDirectionsIsTheMinimum) {
  const v1::Job job = submit();
  erode(5000, 40);  // more than one chunk
  EXPECT_EQ(field(job.id()), expected_field(5000, 40));
}

TEST_F(ReportTest, AnyOrderWithRepetitionsGivesTheSameBytes) {
  constexpr std::uint32_t kPoints = 4100;
  constexpr std::uint32_t kDirections = 16;
  const std::string expected = expected_field(kPoints, kDirections);
  for (unsigned seed = 0; seed < 5; ++seed) {
    const v1::Job job = submit("OFF " + std::to_string(seed));
    prepare(kPoints, kDirections);
    const v1::Lease block = lease();
    std::mt19937 random(seed);
    std::vector<std::uint64_t> positions;
    for (std::uint64_t p = 0; p < kDirections; ++p) positions.insert(positions.end(), {p, p});
    std::shuffle(positions.begin(), positions.end(), random);
    for (std::uint64_t p : positions) report(block, p, p + 1);
    store_->give_back(block.token());
    EXPECT_EQ(field(job.id()), expected) << "seed " << seed;
    store_->cancel(job.id());
  }
}

TEST_F(ReportTest, UnsortedRecordsOfOneReport) {
  const v1::Job job = submit();
  prepare(9000, 16);
  const v1::Lease block = lease();
  const v1::FieldRecords sorted = made_up_records(block.job(), 0, 16);
  std::vector<int> order(static_cast<std::size_t>(sorted.point_size()));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  v1::FieldRecords shuffled;
  for (int i : order) {
    shuffled.add_point(sorted.point(i));
    shuffled.add_direction(sorted.direction(i));
    shuffled.add_erosion(sorted.erosion(i));
    shuffled.add_area(sorted.area(i));
  }
  report(block, {range(0, 16)}, shuffled, true);
  EXPECT_EQ(field(job.id()), expected_field(9000, 16));
}

// Small reports wait in a log; readers of the field see them all the same, also after a restart, and
// nothing of the log is left of a finished field.
TEST_F(ReportTest, LoggedRecordsAreInTheField) {
  constexpr std::uint32_t kPoints = 9000, kDirections = 32;
  const v1::Job job = submit();
  prepare(kPoints, kDirections);
  const auto one_by_one = [&](const v1::Lease& block, std::uint64_t begin, std::uint64_t end) {
    std::int64_t most = 0;
    for (std::uint64_t p = begin; p < end; ++p) {
      const v1::FieldRecords all = made_up_records(block.job(), p, p + 1);
      v1::FieldRecords few, rest;
      for (int i = 0; i < all.point_size(); ++i) {
        v1::FieldRecords& part = i % 7 == 0 ? few : rest;
        part.add_point(all.point(i));
        part.add_direction(all.direction(i));
        part.add_erosion(all.erosion(i));
        part.add_area(all.area(i));
      }
      report(block, {}, few);
      most = std::max(most, logged());
      EXPECT_LE(logged(), std::int64_t{kPoints} * 60) << "the log is longer than three fields";
      report(block, {range(p, p + 1)}, rest, p + 1 == block.positions(0).end());
    }
    EXPECT_GT(most, 0);
  };
  const v1::Lease first = lease();
  ASSERT_EQ(first.positions(0).end(), 16U);
  one_by_one(first, 0, 15);
  v1::FieldRecords one;
  one.add_point(8999);
  one.add_direction(3);
  one.add_erosion(0.01);
  one.add_area(2.0);
  report(first, {}, one);
  EXPECT_GT(logged(), 0);
  const std::string before = read_all(*store_->open_input(first.token(), v1::ARTIFACT_KIND_FIELD));
  double erosion = 1;
  std::memcpy(&erosion, before.data() + 8999 * 20, 8);
  EXPECT_EQ(erosion, 0.01);
  open();
  EXPECT_EQ(read_all(*store_->open_input(first.token(), v1::ARTIFACT_KIND_FIELD)), before);
  one_by_one(first, 15, 16);
  one_by_one(lease(), 16, 32);
  EXPECT_EQ(logged(), 0);
  std::string expected = expected_field(kPoints, kDirections), whole = field(job.id());
  EXPECT_EQ(whole.substr(0, 8999 * 20), expected.substr(0, 8999 * 20));
  EXPECT_EQ(whole.substr(8999 * 20), before.substr(8999 * 20));
}

// Written to the log first, a job's first reports would be written twice.
TEST_F(ReportTest, DenseRecordsAreMergedAtOnce) {
  constexpr std::uint32_t kPoints = 9000, kDirections = 16;
  const v1::Job job = submit();
  prepare(kPoints, kDirections);
  const v1::Lease block = lease();
  v1::FieldRecords one;
  one.add_point(8999);
  one.add_direction(0);
  one.add_erosion(made_up_erosion(8999, 0));
  one.add_area(made_up_area(8999, 0));
  report(block, {}, one);
  EXPECT_EQ(logged(), 24);
  report(block, 0, 15);
  EXPECT_EQ(logged(), 24) << "all points, fifteen times";
  report(block, 15, 16, true);
  EXPECT_EQ(field(job.id()), expected_field(kPoints, kDirections));
}

// Every seventh point in each of three parts of the log, and what an earlier server has logged, of all at once.
TEST_F(ReportTest, PartsOfTheLogAreMergedApart) {
  constexpr std::uint32_t kPoints = 3 * kLogPartPoints - 100, kDirections = 16;
  const v1::Job job = submit();
  prepare(kPoints, kDirections);
  const v1::Lease block = lease();
  const auto scattered = [&](std::uint32_t from, std::uint32_t to, std::uint32_t direction) {
    v1::FieldRecords records;
    for (std::uint32_t p = (from + 6) / 7 * 7; p < to; p += 7) {
      records.add_point(p);
      records.add_direction(direction);
      records.add_erosion(made_up_erosion(p, direction));
      records.add_area(made_up_area(p, direction));
    }
    return records;
  };
  report(block, {}, scattered(0, kPoints, 3));
  EXPECT_EQ(logged(), (kPoints + 6) / 7 * 24);
  {
    Database db(database(), Database::Mode::kReadWrite);
    EXPECT_EQ(db.integer("SELECT count(DISTINCT part) FROM field_log"), 3);
    db.execute("UPDATE field_log SET part = NULL, bytes = NULL");
  }
  const std::string before = read_all(*store_->open_input(block.token(), v1::ARTIFACT_KIND_FIELD));
  const std::int64_t old = logged();
  std::int64_t most = 0;
  for (std::uint32_t i = 0; i < 20; ++i) {
    report(block, {}, scattered(kLogPartPoints, 2 * kLogPartPoints, 3));
    EXPECT_TRUE(read_all(*store_->open_input(block.token(), v1::ARTIFACT_KIND_FIELD)) == before);
    most = std::max(most, logged() - old);
  }
  EXPECT_LT(logged() - old, most) << "merged once";
  EXPECT_LE(most, 3 * 20 * kLogPartPoints);
  report(block, 0, 16, true);
  EXPECT_EQ(logged(), 0);
  EXPECT_TRUE(field(job.id()) == expected_field(kPoints, kDirections));
}

TEST_F(ReportTest, SameReportTwiceChangesOnlyCounters) {
  const v1::Job job = submit();
  prepare(100, 16);
  const v1::Lease block = lease();
  report(block, 0, 4);
  const std::string before = read_all(*store_->open_input(block.token(), v1::ARTIFACT_KIND_FIELD));
  report(block, 0, 4);
  EXPECT_EQ(read_all(*store_->open_input(block.token(), v1::ARTIFACT_KIND_FIELD)), before);
  const v1::Job now = store_->job(job.id());
  EXPECT_EQ(now.directions_done(), 4U);
  EXPECT_EQ(now.counters().reports(), 2U);
  EXPECT_EQ(now.counters().directions_reported(), 8U);
  EXPECT_EQ(now.counters().directions_repeated(), 4U);
}

TEST_F(ReportTest, LastReportMayBeRepeated) {
  const v1::Job job = submit();
  prepare(100, 16);
  const v1::Lease block = lease();
  report(block, 0, 16, true);
  EXPECT_EQ(store_->job(job.id()).stage(), v1::JOB_STAGE_DERIVE);
  EXPECT_FALSE(report(block, 0, 16, true).cancelled()) << "its acknowledgement was lost: not an error";
  EXPECT_EQ(store_->job(job.id()).directions_done(), 16U);
  EXPECT_EQ(field(job.id()), expected_field(100, 16));
}

TEST_F(ReportTest, PartialFieldHasEmptyRecords) {
  submit();
  prepare(5000, 16);
  const v1::Lease block = lease();
  v1::FieldRecords one;
  one.add_point(4999);
  one.add_direction(3);
  one.add_erosion(0.5);
  one.add_area(2.0);
  report(block, {range(0, 1)}, one);
  const std::string bytes = read_all(*store_->open_input(block.token(), v1::ARTIFACT_KIND_FIELD));
  ASSERT_EQ(bytes.size(), 5000U * 20);
  const auto record = [&](std::size_t point) {
    double erosion = 0;
    double area = 0;
    std::uint32_t direction = 0;
    std::memcpy(&erosion, bytes.data() + point * 20, 8);
    std::memcpy(&area, bytes.data() + point * 20 + 8, 8);
    std::memcpy(&direction, bytes.data() + point * 20 + 16, 4);
    return std::tuple(erosion, area, direction);
  };
  EXPECT_EQ(record(0), std::tuple(std::numeric_limits<double>::infinity(), 0.0, wire::kNoDirection));
  EXPECT_EQ(record(4998), std::tuple(std::numeric_limits<double>::infinity(), 0.0, wire::kNoDirection));
  EXPECT_EQ(record(4999), std::tuple(0.5, 2.0, 3U));
}

TEST_F(ReportTest, TiesGoToTheSmallerDirectionWithItsArea) {
  submit();
  prepare(1, 16);
  const v1::Lease block = lease();
  const auto send = [&](std::uint64_t position, std::uint32_t direction, double erosion, double area) {
    v1::FieldRecords one;
    one.add_point(0);
    one.add_direction(direction);
    one.add_erosion(erosion);
    one.add_area(area);
    report(block, {range(position, position + 1)}, one);
  };
  const auto stored = [&] {
    const std::string bytes = read_all(*store_->open_input(block.token(), v1::ARTIFACT_KIND_FIELD));
    double area = 0;
    std::memcpy(&area, bytes.data() + 8, 8);
    return area;
  };
  send(0, 7, 1.0, 70);
  send(1, 9, 1.0, 90);
  EXPECT_EQ(stored(), 70);
  send(2, 5, 1.0, 50);
  EXPECT_EQ(stored(), 50);
  send(3, 8, 0.5, 80);
  EXPECT_EQ(stored(), 80);
}

TEST_F(ReportTest, RangesStayCoalesced) {
  const v1::Job job = submit();
  prepare(1, 16);
  const v1::Lease block = lease();
  const v1::FieldRecords nothing;
  report(block, {range(2, 4), range(6, 8)}, nothing);
  EXPECT_EQ(done(store_->job(job.id())), (decltype(done(job)){{2, 4}, {6, 8}}));
  report(block, {range(4, 6)}, nothing);
  EXPECT_EQ(done(store_->job(job.id())), (decltype(done(job)){{2, 8}}));
  report(block, {range(0, 10), range(12, 13)}, nothing);
  EXPECT_EQ(done(store_->job(job.id())), (decltype(done(job)){{0, 10}, {12, 13}}));
  EXPECT_EQ(store_->job(job.id()).directions_done(), 11U);
  EXPECT_EQ(store_->job(job.id()).counters().directions_repeated(), 6U);
}

TEST_F(ReportTest, RandomRangesAreCountedOnce) {
  const v1::Job job = submit();
  prepare(1, 1024);
  const v1::Lease block = lease();
  const std::uint64_t first = block.positions(0).begin();
  const std::uint64_t count = block.positions(0).end() - first;
  std::mt19937 random(7);
  std::vector<bool> reached(count);
  for (int i = 0; i < 200; ++i) {
    const std::uint64_t begin = random() % count;
    const std::uint64_t end = begin + 1 + random() % std::min<std::uint64_t>(3, count - begin);
    const std::uint64_t stop = std::min(end, count);
    report(block, {range(first + begin, first + stop)}, {});
    std::fill(reached.begin() + static_cast<long>(begin), reached.begin() + static_cast<long>(stop), true);
    ASSERT_EQ(store_->job(job.id()).directions_done(),
              static_cast<std::uint64_t>(std::count(reached.begin(), reached.end(), true)));
  }
}

TEST_F(ReportTest, BadReportsAreRefusedWhole) {
  const v1::Job job = submit();
  prepare(10, 40);
  const v1::Lease block = lease();
  const auto records = [](std::uint32_t point, std::uint32_t direction, double erosion, double area) {
    v1::FieldRecords one;
    one.add_point(point);
    one.add_direction(direction);
    one.add_erosion(erosion);
    one.add_area(area);
    return one;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const v1::FieldRecords& bad :
       {records(10, 0, 1, 1), records(0, 40, 1, 1), records(0, 0, -1, 1), records(0, 0, nan, 1),
        records(0, 0, infinity, 1), records(0, 0, 1, -1), records(0, 0, 1, nan)}) {
    EXPECT_STORE_ERROR(report(block, {range(0, 1)}, bad), kInvalid);
  }
  v1::FieldRecords uneven = records(0, 0, 1, 1);
  uneven.add_point(1);
  EXPECT_STORE_ERROR(report(block, {range(0, 1)}, uneven), kInvalid);
  const v1::FieldRecords good = records(0, 0, 1, 1);
  EXPECT_STORE_ERROR(report(block, {range(0, 1), range(15, 17)}, good), kInvalid);  // block ends at 16
  EXPECT_STORE_ERROR(report(block, {range(3, 3)}, good), kInvalid);
  EXPECT_STORE_ERROR(report(block, {range(0, 15)}, good, true), kInvalid);  // 15 is missing
  const std::vector<v1::PositionRange> flood(17, range(0, 1));
  EXPECT_STORE_ERROR(report(block, flood, good), kInvalid);
  EXPECT_EQ(store_->job(job.id()).directions_done(), 0U);
  EXPECT_EQ(store_->job(job.id()).counters().reports(), 0U);
  const std::string bytes = read_all(*store_->open_input(block.token(), v1::ARTIFACT_KIND_FIELD));
  double erosion = 0;
  std::memcpy(&erosion, bytes.data(), 8);
  EXPECT_EQ(erosion, infinity);
}

TEST_F(ReportTest, FloodOfRecordsIsRefused) {
  RecordBatch batch(1, 16, 2.0);
  v1::FieldRecords records;
  for (int i = 0; i < 65; ++i) {
    records.add_point(0);
    records.add_direction(0);
    records.add_erosion(1);
    records.add_area(1);
  }
  EXPECT_STORE_ERROR(batch.append(records), kInvalid);
}

// A worker that says E = 0 everywhere would make a job that is done, with an empty skeleton.
TEST_F(ReportTest, OnlyVolumesOfThisSolidAreTaken) {
  const auto batch_of = [](double erosion) {
    RecordBatch batch(1, 16, 2.0);
    v1::FieldRecords records;
    records.add_point(0);
    records.add_direction(0);
    records.add_erosion(erosion);
    records.add_area(1);
    batch.append(records);
  };
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double wrong : {0.0, -0.0, -1.0, 2.0001, infinity, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_STORE_ERROR(batch_of(wrong), kInvalid);
  }
  for (const double right : {std::numeric_limits<double>::min(), 1.0, 2.0, 2.0 * (1 + 0x1p-36)}) {
    EXPECT_NO_THROW(batch_of(right)) << right;
  }
}

TEST_F(ReportTest, NegativeZeroIsStoredAsZero) {
  RecordBatch batch(1, 16, 2.0);
  v1::FieldRecords records;
  records.add_point(0);
  records.add_direction(0);
  records.add_erosion(1);
  records.add_area(-0.0);
  batch.append(records);
  EXPECT_FALSE(std::signbit(batch.records()[0].area));
}

TEST_F(ReportTest, MeasuresTheLongestGap) {
  const v1::Job job = submit();
  prepare(1, 16);
  const v1::Lease block = lease();
  clock_.advance(300);
  report(block, 0, 1);
  clock_.advance(700);
  store_->renew(block.token());
  clock_.advance(200);
  report(block, 1, 2);
  clock_.advance(100);
  report(block, 2, 3);
  EXPECT_EQ(store_->job(job.id()).counters().longest_report_gap_ms(), 900U);
}

TEST_F(ReportTest, SurvivesARestartMidway) {
  const v1::Job job = submit();
  prepare(5000, 40);
  v1::Lease block = lease();
  report(block, 0, 7);
  open();
  report(block, 7, 16, true);
  open();
  finish_block(lease());
  open();
  finish_block(lease());
  derive();
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(field(job.id()), expected_field(5000, 40));
}

// A worker tells values of directions that it has not finished, and another computes these again.
TEST_F(ReportTest, WhatSeveralToldOfCountsOnce) {
  const v1::Job job = submit();
  prepare(4, 32);
  const v1::Lease block = lease("worker-b");
  v1::PositionRange done;
  done.set_end(3);
  report(block, {done}, made_up_records(block.job(), 0, 5), false);
  store_->give_back(block.token());
  while (store_->job(job.id()).directions_done() < 32) finish_block(lease("worker-a"));
  std::uint64_t sum = 0;
  const auto givers = store_->events(job.id(), 0).givers();
  for (const v1::Giver& giver : givers) sum += giver.directions();
  EXPECT_EQ(givers.size(), 2);
  EXPECT_EQ(sum, 32U);
}

}  // namespace
}  // namespace affskel::server
