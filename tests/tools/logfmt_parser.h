#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

namespace affskel::tests {

/// One line of a log in logfmt, read strictly: fields `key=value` with one space between them, each key once
/// and of letters, digits and '_', values bare (visible ASCII without '"', '=' and '\') or in quotes with
/// JSON's escapes. Written from the format alone, so that it shares no mistake with the writer.
/// @throws std::runtime_error that names the place.
class LogfmtParser {
 public:
  explicit LogfmtParser(std::string_view line) : line_(line) {}

  std::map<std::string, std::string> parse() {
    std::map<std::string, std::string> fields;
    for (;;) {
      std::string name = key();
      if (!fields.emplace(name, value()).second) fail("the key " + name + " stands there twice");
      if (at_ == line_.size()) return fields;
      expect(' ');
    }
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw std::runtime_error("column " + std::to_string(at_ + 1) + ": " + why +
                             ", in: " + std::string(line_));
  }
  char next() {
    if (at_ == line_.size()) fail("the line ends too early");
    return line_[at_++];
  }
  void expect(char c) {
    if (next() != c) fail(std::string("no '") + c + "'");
  }

  std::string key() {
    std::string text;
    while (at_ < line_.size() && line_[at_] != '=') text += next();
    if (text.empty()) fail("no key");
    for (const char c : text) {
      const bool good =
          (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
      if (!good) fail("a key '" + text + "'");
    }
    expect('=');
    return text;
  }

  std::string value() {
    if (at_ < line_.size() && line_[at_] == '"') return quoted();
    std::string text;
    while (at_ < line_.size() && line_[at_] != ' ') {
      const char c = next();
      if (c <= 0x20 || c == 0x7F || c == '"' || c == '=' || c == '\\')
        fail("a bare value with such a character");
      text += c;
    }
    if (text.empty()) fail("no value");
    return text;
  }

  std::string quoted() {
    expect('"');
    std::string text;
    for (char c = next(); c != '"'; c = next()) {
      if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) fail("a control character");
      text += c == '\\' ? escaped() : c;
    }
    return text;
  }

  char escaped() {
    switch (const char c = next()) {
      case '"':
      case '\\':
        return c;
      case 'n':
        return '\n';
      case 'r':
        return '\r';
      case 't':
        return '\t';
      case 'u':
        return control();
      default:
        fail("an unknown escape");
    }
  }

  // Nothing but control characters needs it.
  char control() {
    const std::string digits = {next(), next(), next(), next()};
    std::size_t used = 0;
    const unsigned long code = std::stoul(digits, &used, 16);
    if (used != 4 || (code >= 0x20 && code != 0x7F)) fail("\\u" + digits);
    return static_cast<char>(code);
  }

  const std::string_view line_;
  std::size_t at_ = 0;
};

}  // namespace affskel::tests
