#include "client/text/printable.h"

#include <gtest/gtest.h>

namespace affskel::client {
namespace {

TEST(Printable, LeavesWhatDrivesNoTerminal) {
  EXPECT_EQ(printable("Köpfe ü – 体\tx\ny"), "Köpfe ü – 体\tx\ny");
  EXPECT_EQ(printable("\xc2\xa0\xc3\x9b"), "\xc2\xa0\xc3\x9b");  // U+00A0, U+00DB
}

TEST(Printable, ReplacesControlCharacters) {
  EXPECT_EQ(printable("a\x1b[31mb\x7f\r"), "a?[31mb??");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "?31m");  // CSI as one character
  EXPECT_EQ(printable("a\xe2\x80\xae"
                      "b\xe2\x81\xa6\xe2\x80\xa8"),
            "a?b??");
  EXPECT_EQ(printable("\x9b"
                      "31m"),
            "\xef\xbf\xbd"
            "31m");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "?");
}

TEST(Printable, ReplacesWhatIsNotSeen) {
  for (const char* unseen :
       {"\u061C", "\uFEFF", "\u2060", "\u200B", "\u00AD", "\u3164", "\u034F", "\U000E0041"}) {
    EXPECT_EQ(printable(std::string("a") + unseen + "b"), "a?b") << unseen;
  }
}

TEST(Printable, LeavesWhatShapesLetters) {
  for (const char* text :
       {"\u0645\u06CC\u200C\u062E\u0648\u0627\u0647\u0645", "\U0001F469\u200D\U0001F52C", "\u2764\uFE0F"}) {
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Printable, OneLineHasNoLineEnds) {
  EXPECT_EQ(one_line("a\nb\tc"), "a b c");
}

}  // namespace
}  // namespace affskel::client
