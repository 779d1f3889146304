#include "core/base/disjoint_sets.h"

#include <gtest/gtest.h>

namespace affskel::core {
namespace {

TEST(DisjointSets, SmallestMemberStandsForItsSet) {
  DisjointSets sets(6);
  EXPECT_TRUE(sets.unite(5, 3));
  EXPECT_TRUE(sets.unite(4, 5));
  EXPECT_FALSE(sets.unite(3, 4));
  EXPECT_TRUE(sets.unite(4, 1));
  for (const std::uint32_t a : {1U, 3U, 4U, 5U}) EXPECT_EQ(sets.find(a), 1U);
  EXPECT_EQ(sets.find(0), 0U);
  EXPECT_EQ(sets.find(2), 2U);
}

}  // namespace
}  // namespace affskel::core
