#include "wire/direction_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace affskel::wire {
namespace {

TEST(DirectionOrder, HasEveryDirectionOnce) {
  for (const std::size_t count : {0, 1, 2, 3, 4, 12, 500, 5120}) {
    std::vector<std::uint32_t> all(count);
    std::iota(all.begin(), all.end(), 0);
    std::vector<std::uint32_t> order = directions_in_order(count);
    std::sort(order.begin(), order.end());
    EXPECT_EQ(order, all);
  }
}

// In the order of their numbers a stretch would hold those of one tenth.
TEST(DirectionOrder, AnyStretchHasDirectionsFromAllOver) {
  const std::vector<std::uint32_t> order = directions_in_order(1000);
  for (std::size_t begin = 0; begin + 40 <= order.size(); ++begin) {
    std::set<std::uint32_t> tenths;
    for (std::size_t p = begin; p < begin + 40; ++p) tenths.insert(order[p] / 100);
    ASSERT_EQ(tenths.size(), 10U) << begin;
  }
}

}  // namespace
}  // namespace affskel::wire
