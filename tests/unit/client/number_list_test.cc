#include "client/number_list.h"

#include <gtest/gtest.h>

namespace affskel::client {
namespace {

TEST(NumberList, TakesFiniteNumbersOnly) {
  EXPECT_EQ(parse_number("1.5e3"), 1500);
  EXPECT_EQ(parse_number("+2"), 2);
  EXPECT_EQ(parse_number(" -2 "), -2);
  for (const char* bad : {"", " ", "x", "1x", "nan", "inf", "+-1", "++1", "1e999", "1 2", "0x10"}) {
    EXPECT_FALSE(parse_number(bad)) << bad;
  }
}

TEST(NumberList, SplitsAtCommas) {
  EXPECT_EQ(parse_numbers("1, -2,3e1"), (std::vector<double>{1, -2, 30}));
  EXPECT_EQ(parse_numbers("7"), (std::vector<double>{7}));
  for (const char* bad : {"", "1,", ",1", "1,,2", "1;2"}) EXPECT_FALSE(parse_numbers(bad)) << bad;
}

}  // namespace
}  // namespace affskel::client
