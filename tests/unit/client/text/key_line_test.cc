#include "client/text/key_line.h"

#include <gtest/gtest.h>

namespace affskel::client {
namespace {

TEST(PlaceInBox, IsTheBoxesToAMillionth) {
  EXPECT_EQ(place_in_box({-80.00399514228667, 10.022689213393136, -4.2862638e-15}, 160), "-80.004 10.0227 0");
  EXPECT_EQ(place_in_box({4500000.25123456, 0.0001, 2}, 1), "4500000.251235 0.0001 2")
      << "far from the origin";
  EXPECT_EQ(place_in_box({0.00012345678, 1e-11, 0}, 0.0002), "0.0001234568 0 0") << "small";
  EXPECT_EQ(place_in_box({3, 0, -2.5}, 0), "3 0 -2.5") << "a point";
}

}  // namespace
}  // namespace affskel::client
