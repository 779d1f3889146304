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

TEST(Printable, OneLineHasNoLineEnds) {
  EXPECT_EQ(one_line("a\nb\tc"), "a b c");
}

}  // namespace
}  // namespace affskel::client
