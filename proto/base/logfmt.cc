#include "base/logfmt.h"

#include <algorithm>
#include <cstdio>

#include "base/utf8.h"

namespace affskel::base {
namespace {

bool is_bare(char c) {
  return c > 0x20 && c < 0x7F && c != '"' && c != '\\' && c != '=';
}

void append_escaped(std::string& to, char c) {
  const auto byte = static_cast<unsigned char>(c);
  if (c == '"' || c == '\\') {
    to += '\\';
    to += c;
  } else if (c == '\n') {
    to += "\\n";
  } else if (c == '\r') {
    to += "\\r";
  } else if (c == '\t') {
    to += "\\t";
  } else if (byte < 0x20 || byte == 0x7F) {
    char escaped[7];
    std::snprintf(escaped, sizeof escaped, "\\u%04x", static_cast<unsigned>(byte));
    to += escaped;
  } else {
    to += c;
  }
}

}  // namespace

void append_field(std::string& entry, const LogField& field) {
  if (!entry.empty()) entry += ' ';
  entry.append(field.key) += '=';
  if (!field.value.empty() && std::all_of(field.value.begin(), field.value.end(), is_bare)) {
    entry += field.value;
    return;
  }
  entry += '"';
  for (const char c : to_utf8(field.value)) append_escaped(entry, c);
  entry += '"';
}

std::string logfmt(std::string_view event, std::initializer_list<LogField> fields) {
  std::string entry;
  append_field(entry, {"event", event});
  for (const LogField& field : fields) append_field(entry, field);
  return entry;
}

}  // namespace affskel::base
