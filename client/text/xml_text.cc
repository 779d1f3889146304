#include "client/text/xml_text.h"

#include "base/utf8.h"

namespace affskel::client {

std::string xml_text(std::string_view text) {
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
      default:
        safe += c;
    }
  }
  return safe;
}

}  // namespace affskel::client
