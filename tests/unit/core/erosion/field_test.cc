#include "core/erosion/field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <random>
#include <thread>

namespace affskel::core {
namespace {

std::vector<std::uint32_t> taken_points(ErosionField& field) {
  std::vector<std::uint32_t> points;
  field.take_changes([&](std::uint32_t p, const FieldValue& value) {
    EXPECT_EQ(value.erosion, field.value(p).erosion);
    points.push_back(p);
  });
  return points;
}

TEST(ErosionField, KeepsTheLeastErosionThenTheLeastDirection) {
  ErosionField field(1, false);
  EXPECT_EQ(field.value(0).direction, FieldValue::kNoDirection);
  field.offer(0, {2, 10, 5});
  field.offer(0, {3, 11, 1});
  EXPECT_EQ(field.value(0).direction, 5U);
  field.offer(0, {2, 12, 7});
  EXPECT_EQ(field.value(0).direction, 5U);
  field.offer(0, {2, 13, 4});
  EXPECT_EQ(field.value(0).direction, 4U);
  EXPECT_EQ(field.value(0).area, 13);
}

// Points far apart and on both sides of every power of two up to a thousand.
TEST(ErosionField, TellsEachChangeOnceInAscendingOrder) {
  ErosionField field(1000, true);
  const std::vector<std::uint32_t> points{0, 1, 2, 15, 16, 17, 31, 32, 63, 64, 127, 128, 511, 512, 999};
  for (auto p = points.rbegin(); p != points.rend(); ++p) field.offer(*p, {5, 1, 1});
  field.offer(2, {4, 1, 2});
  EXPECT_EQ(taken_points(field), points);
  EXPECT_TRUE(taken_points(field).empty());
  field.offer(2, {4, 1, 9});  // no improvement
  EXPECT_TRUE(taken_points(field).empty());
  field.offer(2, {3, 1, 9});
  EXPECT_EQ(taken_points(field), (std::vector<std::uint32_t>{2}));
}

TEST(ErosionField, TellsChangesInParts) {
  ErosionField field(1000, true);
  std::vector<std::uint32_t> points;
  for (std::uint32_t p = 0; p < 1000; p += 3) points.push_back(p);
  for (const std::uint32_t p : points) field.offer(p, {5, 1, 1});
  EXPECT_EQ(field.changes(), points.size());
  std::vector<std::uint32_t> taken;
  for (std::size_t part = 0; part < 7; ++part) {
    const std::size_t before = taken.size();
    field.take_changes([&](std::uint32_t p, const FieldValue&) { taken.push_back(p); }, part, 7);
    EXPECT_NEAR(static_cast<double>(taken.size() - before), 1000 / 21.0, 12);
    EXPECT_EQ(field.changes(), points.size() - taken.size());
  }
  EXPECT_EQ(taken, points);
}

TEST(ErosionField, ABoundRulesOutWhatIsGreaterOnly) {
  ErosionField field(4, true);
  for (std::uint32_t p = 0; p < 4; ++p) field.offer(p, {5, 1, 3});
  field.bound(0, 5);    // by an equal value: which direction is the lesser one is not known here
  field.bound(1, 4);    // outdone before it was told
  field.bound(2, 5.5);  // worse
  EXPECT_EQ(taken_points(field), (std::vector<std::uint32_t>{0, 2, 3}));
  EXPECT_EQ(field.value(0).direction, 3U);
  EXPECT_EQ(field.value(1).erosion, 4);
  EXPECT_EQ(field.value(1).direction, FieldValue::kNoDirection);
  field.offer(1, {4.5, 1, 0});
  EXPECT_TRUE(taken_points(field).empty());
  field.offer(1, {4, 1, 1000});  // as good as the bound, which may have been rounded up
  EXPECT_EQ(taken_points(field), (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(field.value(1).direction, 1000U);
}

TEST(ErosionField, TellsNoChangesUnlessAskedTo) {
  ErosionField field(20, false);
  field.offer(3, {5, 1, 1});
  EXPECT_TRUE(taken_points(field).empty());
}

// A point offered by several threads while changes are taken: after the threads are done, a last call
// must tell every point whose value the calls before could not have seen.
TEST(ErosionField, NoImprovementEscapesWhoeverTakesTheChanges) {
  constexpr std::uint32_t kPoints = 4;
  for (int round = 0; round < 200; ++round) {
    ErosionField field(kPoints, true);
    std::vector<double> seen(kPoints, std::numeric_limits<double>::infinity());
    const auto take = [&] {
      field.take_changes(
          [&](std::uint32_t p, const FieldValue& value) { seen[p] = std::min(seen[p], value.erosion); });
    };
    std::vector<std::thread> threads;
    std::atomic<int> running{2};
    for (std::uint32_t t = 0; t < 2; ++t) {
      threads.emplace_back([&, t] {
        for (std::uint32_t i = 0; i < 200; ++i) field.offer(i % kPoints, {1000.0 - i, 1, t});
        --running;
      });
    }
    while (running > 0) take();
    for (std::thread& thread : threads) thread.join();
    take();
    for (std::uint32_t p = 0; p < kPoints; ++p) ASSERT_EQ(seen[p], field.value(p).erosion);
  }
}

TEST(ErosionField, OffersFromManyThreadsMergeAsInAnyOrder) {
  constexpr std::uint32_t kPoints = 50;
  std::vector<std::pair<std::uint32_t, FieldValue>> offers;
  std::mt19937_64 random(3);
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const auto direction = static_cast<std::uint32_t>(random() % 300);
    const auto point = static_cast<std::uint32_t>(random() % kPoints);
    offers.push_back(
        {point,
         {static_cast<double>(random() % 40), static_cast<double>(direction) + 1000.0 * point, direction}});
  }
  ErosionField one(kPoints, true), many(kPoints, true);
  for (const auto& [point, value] : offers) one.offer(point, value);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (std::size_t i = 0; i < offers.size(); ++i) {
        const auto& [point, value] = offers[(i * 7919 + t * 5003) % offers.size()];
        many.offer(point, value);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::uint32_t p = 0; p < kPoints; ++p) {
    EXPECT_EQ(one.value(p).erosion, many.value(p).erosion);
    EXPECT_EQ(one.value(p).direction, many.value(p).direction);
    EXPECT_EQ(one.value(p).area, many.value(p).area);
  }
}

}  // namespace
}  // namespace affskel::core
