#include "core/base/parity_rows.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <set>

#include "core/base/split_mix64.h"

namespace affskel::core {
namespace {

ParityRow row_of(std::uint32_t bits) {
  ParityRow row;
  for (std::uint32_t n = 0; n < 32; ++n)
    if ((bits >> n & 1U) != 0) row.push_back(n);
  return row;
}

// All sums of random rows, by machine words.
TEST(ParityRows, SpanAllSums) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SplitMix64 random(seed);
    std::set<std::uint32_t> sums{0};
    ParityRows rows;
    for (int n = 0; n < 6; ++n) {
      const auto bits = static_cast<std::uint32_t>(random.next() & random.next() & 0xFF);
      EXPECT_EQ(rows.add(row_of(bits)), !sums.contains(bits)) << seed;
      const std::set<std::uint32_t> before = sums;
      for (const std::uint32_t sum : before) sums.insert(sum ^ bits);
    }
    EXPECT_EQ(std::uint64_t{1} << rows.rank(), sums.size());
    for (std::uint32_t bits = 0; bits < 256; ++bits)
      EXPECT_EQ(rows.contains(row_of(bits)), sums.contains(bits)) << seed;
  }
}

}  // namespace
}  // namespace affskel::core
