#include "client/render/picture_letters.h"

#include <gtest/gtest.h>

#include <string>

namespace affskel::client {
namespace {

// Each letter before its mark; '#' what the font has not.
std::string written(const std::string& text) {
  std::string told;
  for (const PictureLetter letter : picture_letters(text)) {
    told += letter.base == 0 ? '#' : letter.base;
    if (letter.mark != 0) told += letter.mark;
  }
  return told;
}

TEST(PictureLetters, AreThoseOfTheTextWithMarks) {
  EXPECT_EQ(written("body-7 ~^"), "body-7 ~^");
  EXPECT_EQ(written("Jos\u00E9 M\u00FCller"), "Jose' Mu:ller");
  EXPECT_EQ(written("\u0141\u00F3d\u017A, \u010Ce\u0161tina, \u0130\u0131"), "L/o'dz', Cvesvtina, I.i_");
  EXPECT_EQ(written("\u00C0\u00FF\u0100\u017E\u0150\u015F\u0219"), "A`y:A-zvO\"s,s,")
      << "ends of the table, too";
}

TEST(PictureLetters, MayBeSeveralForACharacter) {
  EXPECT_EQ(written("Stra\u00DFe \u00C6on \u2013 \u201Cx\u201D\u2026"), "Strasse AEon - \"x\"...");
}

// As macOS writes names of files.
TEST(PictureLetters, TakeMarksThatFollow) {
  EXPECT_EQ(written("Jose\u0301 u\u0308 x\u0334"), "Jose' u: x");
  EXPECT_EQ(written("\u0301a"), "#a") << "of nothing";
}

TEST(PictureLetters, OfOtherAlphabetsAreOneEach) {
  EXPECT_EQ(written("\u03B1\u0416\u5F62\U0001F600!"), "####!");
  EXPECT_EQ(written("a\xC3\xFF"), "a##") << "no UTF-8";
}

}  // namespace
}  // namespace affskel::client
