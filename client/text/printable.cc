#include "client/text/printable.h"

#include <unicode/uchar.h>
#include <unicode/utf8.h>

#include <algorithm>
#include <cstdint>

#include "base/utf8.h"

namespace affskel::client {
namespace {

/// Joiners and the selectors of emoji: they shape letters that are seen.
bool shapes_letters(UChar32 c) {
  return c == 0x200C || c == 0x200D || c == 0xFE0E || c == 0xFE0F;
}

bool is_unseen(UChar32 c) {
  if (c == '\n' || c == '\t' || shapes_letters(c)) return false;
  constexpr std::uint32_t kMask = U_GC_CC_MASK | U_GC_ZL_MASK | U_GC_ZP_MASK;
  return (U_GET_GC_MASK(c) & kMask) != 0 || u_hasBinaryProperty(c, UCHAR_BIDI_CONTROL) != 0 ||
         u_hasBinaryProperty(c, UCHAR_DEFAULT_IGNORABLE_CODE_POINT) != 0;
}

}  // namespace

std::string printable(std::string_view text) {
  const std::string whole = base::to_utf8(text);
  std::string safe;
  safe.reserve(whole.size());
  const auto size = static_cast<std::int32_t>(whole.size());
  for (std::int32_t at = 0; at < size;) {
    const std::int32_t begin = at;
    UChar32 character = 0;
    U8_NEXT_UNSAFE(whole.data(), at, character);  // it is well-formed
    if (is_unseen(character)) {
      safe += '?';
    } else {
      safe.append(whole, static_cast<std::size_t>(begin), static_cast<std::size_t>(at - begin));
    }
  }
  return safe;
}

std::string one_line(std::string_view text) {
  std::string safe = printable(text);
  std::replace_if(
      safe.begin(), safe.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  return safe;
}

}  // namespace affskel::client
