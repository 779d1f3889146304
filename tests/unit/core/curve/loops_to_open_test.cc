#include "core/curve/loops_to_open.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

#include "core/base/split_mix64.h"

namespace affskel::core {
namespace {

std::vector<double> nothing(std::uint32_t) {
  return {};
}

TEST(LoopsToOpen, OpensALoopWhereTheValueIsLeast) {
  const std::vector<Segment> ring{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {3, 4}};
  const std::vector<double> value{4, 2, 3, 5, 1};
  EXPECT_EQ(loops_to_open(5, ring, value, 0, nothing), (std::vector<std::uint32_t>{1}));
}

// A ring that goes through a tunnel stays, and of two that go through the same one the greater.
TEST(LoopsToOpen, KeepsWhatGoesThroughATunnel) {
  const std::vector<Segment> theta{{0, 1}, {1, 2}, {0, 3}, {3, 2}, {0, 2}};
  const std::vector<double> value{5, 6, 3, 2, 4};
  // Only the last segment winds: each loop with it does so once, the loop of the others not at all.
  const auto last = [](std::uint32_t s) { return std::vector<double>{s == 4 ? 1.0 : 0.0}; };
  EXPECT_EQ(loops_to_open(4, theta, value, 1, last), (std::vector<std::uint32_t>{3}));
  // Two tunnels: nothing bounds.
  const auto both = [](std::uint32_t s) {
    return std::vector<double>{s == 4 ? 1.0 : 0.0, s == 2 ? -1.0 : 0.0};
  };
  EXPECT_TRUE(loops_to_open(4, theta, value, 2, both).empty());
  // What winds twice is, modulo 2, nothing.
  const auto twice = [](std::uint32_t s) { return std::vector<double>{s == 4 ? 2.0 : 0.0}; };
  EXPECT_EQ(loops_to_open(4, theta, value, 1, twice).size(), 2U);
}

// Of all sets of segments without a loop that bounds, those that stay weigh most; found by trying all.
TEST(LoopsToOpen, LeavesTheGreatestThatHasNoLoopThatBounds) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SplitMix64 random(seed);
    constexpr std::uint32_t kVertices = 6, kSegments = 9;
    std::set<Segment> drawn;
    while (drawn.size() < kSegments) {
      const auto a = static_cast<std::uint32_t>(random.next() % kVertices);
      const auto b = static_cast<std::uint32_t>(random.next() % kVertices);
      if (a != b) drawn.insert({std::min(a, b), std::max(a, b)});
    }
    const std::vector<Segment> segments(drawn.begin(), drawn.end());
    std::vector<double> value, winding;
    for (std::uint32_t s = 0; s < kSegments; ++s) {
      value.push_back(1 + static_cast<double>(random.next() % 20));
      winding.push_back(static_cast<double>(random.next() % 2));
    }
    // A set has no loop that bounds when no part of it meets all vertices evenly and winds evenly.
    const auto bounds = [&](std::uint32_t set) {
      for (std::uint32_t part = set; part != 0; part = (part - 1) & set) {
        std::uint32_t odd = 0;
        double round = 0;
        for (std::uint32_t s = 0; s < kSegments; ++s) {
          if ((part >> s & 1U) == 0) continue;
          odd ^= (1U << segments[s][0]) ^ (1U << segments[s][1]);
          round += winding[s];
        }
        if (odd == 0 && static_cast<int>(round) % 2 == 0) return true;
      }
      return false;
    };
    double best = 0;
    for (std::uint32_t set = 0; set < (1U << kSegments); ++set) {
      double sum = 0;
      for (std::uint32_t s = 0; s < kSegments; ++s) sum += (set >> s & 1U) != 0 ? value[s] : 0;
      if (sum > best && !bounds(set)) best = sum;
    }
    double left = 0;
    std::uint32_t set = (1U << kSegments) - 1;
    const auto wind = [&](std::uint32_t s) { return std::vector<double>{winding[s]}; };
    for (const std::uint32_t s : loops_to_open(kVertices, segments, value, 1, wind)) set &= ~(1U << s);
    for (std::uint32_t s = 0; s < kSegments; ++s) left += (set >> s & 1U) != 0 ? value[s] : 0;
    EXPECT_FALSE(bounds(set)) << seed;
    EXPECT_EQ(left, best) << seed;
  }
}

}  // namespace
}  // namespace affskel::core
