// Against all boxes, one after another.
#include "core/infimum/four_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "core/base/split_mix64.h"
#include "core/infimum/samples.h"
#include "core/mesh/box.h"
#include "core/shapes/body.h"
#include "core/solid/solid.h"

namespace affskel::core {
namespace {

TEST(FourTreeTest, SelectsWhatAPlaneMeets) {
  for (const std::uint32_t triangles : {1000U, 1234U}) {
    const Solid solid = make_solid(make_body({.triangles = triangles}));
    const std::vector<Box> boxes = boxes_of(solid.mesh);
    FourTree tree;
    const std::vector<std::uint32_t> order = tree.build(boxes);
    std::vector<std::uint32_t> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (std::uint32_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], i);
    SplitMix64 random(7);
    std::vector<std::uint32_t> place(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
    FourTree::Lists lists;
    for (int n = 0; n < 200; ++n) {
      const Vec3 x = 0.4 * draw_vector(random);
      const Vec3 d = draw_direction(random);
      const PlaneHeights plane(x, d);
      const auto meets = [&](const FourBoxes& four) {
        const Four middle = plane.middle(four), reach = plane.reach(four);
        return (middle <= reach) & (middle >= -reach);
      };
      std::vector<std::uint32_t> selected;  // by their places in the order
      for (const std::uint32_t item : tree.select(meets, lists)) selected.push_back(place[item]);
      EXPECT_TRUE(std::is_sorted(selected.begin(), selected.end()));
      std::size_t met = 0;
      for (std::uint32_t i = 0; i < order.size(); ++i) {
        const Box& box = boxes[order[i]];
        const Vec3 half = 0.5 * box.sides();
        const double middle = dot(d, 0.5 * (box.low + box.high) - x);
        const double reach = std::abs(d.x) * half.x + std::abs(d.y) * half.y + std::abs(d.z) * half.z;
        const bool there = std::binary_search(selected.begin(), selected.end(), i);
        if (std::abs(middle) <= reach) {
          EXPECT_TRUE(there) << i;
        }
        if (std::abs(middle) > reach + 2 * double(PlaneHeights::kSlack)) {
          EXPECT_FALSE(there) << i;
        }
        met += there;
      }
      EXPECT_EQ(met, selected.size());
    }
  }
}

// Whichever end is lower.
TEST(FourTreeTest, SelectsSegmentsThatAPlanePasses) {
  SplitMix64 random(3);
  std::vector<Box> segments;
  for (int n = 0; n < 500; ++n) {
    const Vec3 begin = 0.4 * draw_vector(random), end = begin + 0.05 * draw_vector(random);
    segments.push_back({{begin.x, begin.y, begin.z}, {end.x, end.y, end.z}});
  }
  FourTree tree;
  tree.build(segments);
  FourTree::Lists lists;
  for (int n = 0; n < 100; ++n) {
    const Vec3 x = 0.2 * draw_vector(random), d = draw_direction(random);
    const PlaneHeights plane(x, d);
    const auto selected = tree.select(
        [&](const FourBoxes& four) {
          const Four middle = plane.middle(four), reach = plane.reach(four);
          return (middle <= reach) & (middle >= -reach);
        },
        [&](const FourBoxes& four) {
          const Four middle = plane.middle(four), reach = plane.reach_of_segment(four);
          return (middle <= reach) & (middle >= -reach);
        },
        lists);
    const std::set<std::uint32_t> there(selected.begin(), selected.end());
    EXPECT_EQ(there.size(), selected.size());
    for (std::uint32_t i = 0; i < segments.size(); ++i) {
      const double begin = dot(d, segments[i].low - x), end = dot(d, segments[i].high - x);
      const double gap = std::max({0.0, std::min(begin, end), -std::max(begin, end)});
      if (gap == 0) {
        EXPECT_TRUE(there.contains(i)) << i;
      }
      if (gap > 2 * double(PlaneHeights::kSlack)) {
        EXPECT_FALSE(there.contains(i)) << i;
      }
    }
  }
}

// Products with them take a processor a hundred times as long: what no item fills counts, too.
TEST(FourTreeTest, AsksOfNoDenormalNumbers) {
  std::vector<Box> boxes(1234);
  SplitMix64 random(5);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Vec3 p = draw_vector(random);
    boxes[i].include(p);
    if (i % 2 == 0) boxes[i].include(p + Vec3{0, 0.01, 0});
  }
  FourTree tree;
  tree.build(boxes);
  FourTree::Lists lists;
  std::size_t asked = 0;
  tree.select(
      [&](const FourBoxes& four) {
        for (const auto* three : {&four.centre, &four.half}) {
          for (const Four& numbers : *three) {
            for (int i = 0; i < 4; ++i) EXPECT_NE(std::fpclassify(numbers[i]), FP_SUBNORMAL);
          }
        }
        ++asked;
        return four.half[0] >= 0;
      },
      lists);
  EXPECT_GT(asked, boxes.size() / 4);
}

TEST(FourTreeTest, HoldsFewItems) {
  for (const std::size_t count : {1U, 2U, 5U, 9U, 16U, 17U}) {
    std::vector<Box> boxes(count);
    for (std::size_t i = 0; i < count; ++i) boxes[i].include(Vec3{0.01 * static_cast<double>(i), 0, 0});
    FourTree tree;
    tree.build(boxes);
    FourTree::Lists lists;
    const auto all = [](const FourBoxes& four) { return four.half[0] >= 0; };
    EXPECT_EQ(tree.select(all, lists).size(), count);
  }
}

TEST(PlaneHeightsTest, DistancesAreNoLess) {
  Box box;
  box.include(Vec3{0.1, 0.2, 0.3});
  box.include(Vec3{0.2, -0.1, 0.35});
  FourTree tree;
  tree.build({box});
  const Vec3 x{-0.3, 0.4, 0};
  FourTree::Lists lists;
  const double furthest = norm(Vec3{0.2, -0.1, 0.35} - x);
  tree.select(
      [&](const FourBoxes& four) {
        EXPECT_GE(double(PlaneHeights::distance(four, x)[0]), furthest);
        EXPECT_LE(double(PlaneHeights::distance(four, x)[0]), 2 * furthest);
        return four.half[0] >= 0;
      },
      lists);
}

}  // namespace
}  // namespace affskel::core
