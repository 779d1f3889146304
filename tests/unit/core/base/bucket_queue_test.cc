#include "core/base/bucket_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <vector>

#include "core/base/split_mix64.h"

namespace affskel::core {
namespace {

// Against a map, with items put in as others are taken, below and above the number of the last.
TEST(BucketQueue, TakesItemsByNumberThenInTheOrderInWhichTheyCame) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SplitMix64 random(seed);
    BucketQueue<int> queue;
    std::multimap<std::size_t, int> expected;
    std::size_t last = 0;
    int next = 0;
    const auto push = [&] {
      for (std::uint64_t left = random.next() % 4; left > 0; --left, ++next) {
        // Far ones: the ring has to end before them, and to meet them when they are near.
        const std::size_t far =
            random.next() % 8 == 0 ? BucketQueue<int>::kNear - 20 + random.next() % 50 : 0;
        const std::size_t number = random.next() % 20 + far + (last > 10 ? last - 10 : 0);
        queue.push(number, next);
        expected.emplace(std::max(number, last), next);
      }
    };
    for (int turn = 0; turn < 300; ++turn) {
      push();
      std::vector<int> taken;
      if (turn % 3 == 0) {
        taken = {-1};
        EXPECT_NE(queue.pop_wave(taken), expected.empty());
      } else {
        taken.resize(1);
        if (!queue.pop(taken[0])) taken.clear();
      }
      ASSERT_EQ(taken.empty(), expected.empty());
      if (taken.empty()) continue;
      last = expected.begin()->first;
      EXPECT_EQ(queue.current(), last);
      const auto end = turn % 3 == 0 ? expected.upper_bound(last) : std::next(expected.begin());
      std::vector<int> wanted;
      for (auto at = expected.begin(); at != end; ++at) wanted.push_back(at->second);
      EXPECT_EQ(taken, wanted) << seed << ' ' << turn;
      expected.erase(expected.begin(), end);
    }
  }
}

}  // namespace
}  // namespace affskel::core
