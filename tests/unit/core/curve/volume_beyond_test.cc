#include "core/curve/volume_beyond.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/base/split_mix64.h"

namespace affskel::core {
namespace {

TEST(VolumeBeyond, OfALineGrowsFromItsEnds) {
  const std::vector<Segment> line{{0, 1}, {1, 2}, {2, 3}, {3, 4}};
  const std::vector<double> weight{1, 2, 3, 4, 5};
  EXPECT_EQ(volume_beyond(line, weight), (std::vector<double>{0.5, 2, 4.5, 7, 2.5}));
}

TEST(VolumeBeyond, OfALoopIsNothingButItsOwn) {
  const std::vector<Segment> loop{{0, 1}, {1, 2}, {2, 0}, {2, 3}};
  const std::vector<double> weight{1, 1, 1, 8};
  EXPECT_EQ(volume_beyond(loop, weight), (std::vector<double>{0.5, 0.5, 2.5, 4}));
}

// Random graphs, by taking each vertex out and adding up what hangs together.
TEST(VolumeBeyond, IsWhatACutParts) {
  int parted = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SplitMix64 random(seed);
    const auto count = static_cast<std::uint32_t>(1 + random.next() % 20);
    std::vector<Segment> segments;
    for (std::uint32_t b = 1; b < count; ++b) {
      for (std::uint32_t a = 0; a < b; ++a)
        if (random.next() % count == 0) segments.push_back({a, b});
    }
    std::vector<double> weight(count);
    for (double& w : weight) w = static_cast<double>(random.next() % 9);
    const std::vector<double> found = volume_beyond(segments, weight);
    DisjointSets pieces(count);
    for (const auto& [a, b] : segments) pieces.unite(a, b);
    for (std::uint32_t v = 0; v < count; ++v) {
      DisjointSets rest(count);
      for (const auto& [a, b] : segments)
        if (a != v && b != v) rest.unite(a, b);
      std::map<std::uint32_t, double> sums;
      for (std::uint32_t w = 0; w < count; ++w)
        if (w != v && pieces.find(w) == pieces.find(v)) sums[rest.find(w)] += weight[w];
      double all = 0, heaviest = 0;
      for (const auto& [set, sum] : sums) {
        all += sum;
        heaviest = std::max(heaviest, sum);
      }
      EXPECT_EQ(found[v], all - heaviest + 0.5 * weight[v]) << seed << ", " << v;
      parted += sums.size() > 1;
    }
  }
  EXPECT_GT(parted, 300);
}

}  // namespace
}  // namespace affskel::core
