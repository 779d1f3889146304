#include "base/utf8.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>

namespace affskel::base {
namespace {

TEST(Utf8Test, TakesEveryWellFormedCharacter) {
  for (const char* text :
       {"", "plain",
        "m\xC3\xB6"
        "bel",
        "\xE2\x99\xA5", "\xF0\x9F\x99\x82", "\xF4\x8F\xBF\xBF", "\xED\x9F\xBF", "\xEE\x80\x80"}) {
    EXPECT_TRUE(is_utf8(text)) << text;
    EXPECT_EQ(to_utf8(text), text);
  }
}

TEST(Utf8Test, FindsWhatIsNotUtf8) {
  // Stray bytes, a broken end, overlong forms, a surrogate, a value above 10FFFF.
  for (const char* text :
       {"\xFF", "a\x80", "\xC3", "\xE2\x99", "\xC0\x80", "\xC1\xBF", "\xE0\x9F\xBF", "\xF0\x8F\xBF\xBF",
        "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xC3(", "\xE2\x99("}) {
    EXPECT_FALSE(is_utf8(text)) << text;
    EXPECT_TRUE(is_utf8(to_utf8(text))) << text;
  }
}

TEST(Utf8Test, ReplacesOnlyWhatIsWrong) {
  EXPECT_EQ(to_utf8("b\xFF"
                    "ody \xC3\xB6"),
            "b\xEF\xBF\xBD"
            "ody \xC3\xB6");
}

TEST(Utf8Test, CutsBetweenCharacters) {
  const std::string text = "a\xC3\xB6\xE2\x99\xA5\xF0\x9F\x99\x82";  // of 1, 2, 3 and 4 bytes
  const std::size_t ends[] = {0, 1, 3, 6, 10};
  for (std::size_t most = 0; most <= text.size() + 1; ++most) {
    const std::size_t end = *(std::upper_bound(std::begin(ends), std::end(ends), most) - 1);
    EXPECT_EQ(truncate_utf8(text, most), text.substr(0, end)) << most;
  }
  EXPECT_EQ(truncate_utf8("", 0), "");
  EXPECT_EQ(truncate_utf8("\x80\x80\x80", 2), "");
}

}  // namespace
}  // namespace affskel::base
