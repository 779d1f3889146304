#include "base/direction_set.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace affskel::base {
namespace {

TEST(DirectionSet, ReadsItsPartsInTheirOrder) {
  const auto parts = parse_direction_set("sphere:0012+triangles+random:3:18446744073709551615");
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[0].kind, DirectionSetPart::Kind::kSphere);
  EXPECT_EQ(parts[0].count, 12U);
  EXPECT_EQ(parts[0].text(), "sphere:12");
  EXPECT_EQ(parts[1].text(), "triangles");
  EXPECT_EQ(parts[2].kind, DirectionSetPart::Kind::kRandom);
  EXPECT_EQ(parts[2].text(), "random:3:18446744073709551615");
}

TEST(DirectionSet, NamesThePartThatIsWrong) {
  for (const char* bad : {"", "+", "triangles+", "cube", "triangles:3", "sphere", "sphere:", "sphere:0",
                          "sphere:-1", "sphere: 3", "sphere:3.5", "sphere:1e3", "sphere:3:4", "random:3",
                          "random:3:", "random:3:x", "random:3:18446744073709551616", "Triangles"}) {
    EXPECT_THROW(parse_direction_set(bad), std::invalid_argument) << bad;
  }
  try {
    parse_direction_set("triangles+sphere:x+random:1:2");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "directions 'sphere:x': N is not a number; expected triangles, sphere:N or random:N:SEED, "
                 "joined by +");
  }
}

}  // namespace
}  // namespace affskel::base
