#include "core/mesh/same_place.h"

#include <gtest/gtest.h>

namespace affskel::core {
namespace {

TEST(SamePlaceTest, NamesTheFirstOfEqualPoints) {
  const std::vector<Vec3> points{{1, 2, 3}, {0, 2, 3}, {1, 2, 3}, {1, 2, 4}, {0, 2, 3}, {1, 2, 3}};
  EXPECT_EQ(first_at_same_place(points), (std::vector<std::uint32_t>{0, 1, 0, 3, 1, 0}));
  EXPECT_TRUE(first_at_same_place({}).empty());
}

TEST(SamePlaceTest, ZeroHasNoSign) {
  EXPECT_EQ(first_at_same_place({{0.0, -0.0, 5}, {-0.0, -0.0, 5}, {-0.0, 0.0, 5}}),
            (std::vector<std::uint32_t>{0, 0, 0}));
}

}  // namespace
}  // namespace affskel::core
