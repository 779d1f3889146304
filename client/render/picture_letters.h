#pragma once

#include <string_view>
#include <vector>

namespace affskel::client {

/// A letter of a picture's font: printable ASCII with a mark, by which other letters of Latin alphabets are written.
struct PictureLetter {
  char base = 0;  ///< 0: a character that the font has not
  /// 0: none; ` ' ^ ~ : - . " as they look, u a breve, v a caron, o a ring; '/' a stroke through it, ',' one below
  /// it, '_' its dot left out.
  char mark = 0;
};

/// The letters of a text, one for each character: "Jos\xC3\xA9" is J, o, s and an e with '.  Marks may follow their
/// letter as characters, as in file names of macOS.  Where a character has others in its place, such as ss, it is
/// these.
/// @param text UTF-8; each wrong byte is a character that the font has not.
std::vector<PictureLetter> picture_letters(std::string_view text);

}  // namespace affskel::client
