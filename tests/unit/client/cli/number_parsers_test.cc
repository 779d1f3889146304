#include "client/cli/number_parsers.h"

#include <gtest/gtest.h>

#include <string>

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

TEST(NumberList, SharesMayBePercents) {
  EXPECT_EQ(parse_share("0.25"), 0.25);
  EXPECT_EQ(parse_share("10%"), 0.1);
  EXPECT_EQ(parse_share("10 % "), 0.1);
  EXPECT_EQ(parse_share("-1%"), -0.01);
  EXPECT_EQ(parse_share("1e1%"), 0.1);
  for (int thousandths = 1; thousandths < 1000; ++thousandths) {
    const std::string number = std::to_string(thousandths);
    // Of "0.7%" and "0.007"; 0.7 / 100 is another number.
    const std::string percent = "0." + std::string(3 - number.size(), '0') + number;
    EXPECT_EQ(parse_share(percent + "%"), parse_number("0.00" + percent.substr(2))) << percent;
  }
  for (const char* bad : {"", "%", "1%%", "%1", "x%", "1e999%", "nan%"}) {
    EXPECT_FALSE(parse_share(bad)) << bad;
  }
}

TEST(NumberList, SplitsAtCommas) {
  EXPECT_EQ(parse_numbers("1, -2,3e1"), (std::vector<double>{1, -2, 30}));
  EXPECT_EQ(parse_numbers("7"), (std::vector<double>{7}));
  for (const char* bad : {"", "1,", ",1", "1,,2", "1;2"}) EXPECT_FALSE(parse_numbers(bad)) << bad;
}

}  // namespace
}  // namespace affskel::client
