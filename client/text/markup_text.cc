#include "client/text/markup_text.h"

#include "base/utf8.h"

namespace affskel::client {

std::string markup_text(std::string_view text) {
  std::string safe;
  for (const char c : base::to_utf8(text)) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";  // which HTML 4 knows, too
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

}  // namespace affskel::client
