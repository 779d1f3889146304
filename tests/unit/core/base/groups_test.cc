#include "core/base/groups.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>

namespace affskel::core {
namespace {

TEST(Groups, HoldTheirValuesInTheOrderOfTheList) {
  std::mt19937 random(1);
  std::vector<std::pair<std::size_t, int>> list;
  std::vector<std::vector<int>> expected(20);
  for (int n = 0; n < 200; ++n) {
    list.emplace_back(3 * (random() % 6), n);  // many groups are empty
    expected[list.back().first].push_back(n);
  }
  const Groups<int> groups(20, [&](const auto& put) {
    for (const auto& [group, value] : list) put(group, value);
  });
  ASSERT_EQ(groups.size(), 20U);
  for (std::size_t g = 0; g < groups.size(); ++g)
    EXPECT_EQ(std::vector<int>(groups[g].begin(), groups[g].end()), expected[g]) << g;
}

TEST(Groups, MayBeNone) {
  EXPECT_EQ(Groups<int>().size(), 0U);
  EXPECT_EQ(Groups<int>(0, [](const auto&) {}).size(), 0U);
}

}  // namespace
}  // namespace affskel::core
