#include "core/text/text_rows.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/base/error.h"

namespace affskel::core {
namespace {

enum class Kind : std::uint8_t { kWord, kBlank, kSpecial };

constexpr std::array<Kind, 256> kind_table() {
  std::array<Kind, 256> kinds{};
  for (char c : {' ', '\t', '\v', '\f'}) kinds[static_cast<unsigned char>(c)] = Kind::kBlank;
  for (char c : {'\0', '\r', '#'}) kinds[static_cast<unsigned char>(c)] = Kind::kSpecial;
  return kinds;
}
constexpr std::array<Kind, 256> kKinds = kind_table();

inline Kind kind_of(char c) {
  return kKinds[static_cast<unsigned char>(c)];
}

constexpr std::string_view kBlanks = " \t\r\n\v\f";

}  // namespace

bool TextRows::next() {
  while (!rest_.empty()) {
    ++line_;
    const std::size_t end = rest_.find(end_);
    const std::string_view text = rest_.substr(0, end);
    rest_ = end == std::string_view::npos ? std::string_view{} : rest_.substr(end + 1);
    split(text);
    if (!words_.empty()) return true;
  }
  return false;
}

// Most lines are plain words between blanks: one look at each character.
void TextRows::split(std::string_view text) {
  words_.clear();
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  text_ = text;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (;;) {
    while (at != end && kind_of(*at) == Kind::kBlank) ++at;
    const char* const begin = at;
    while (at != end && kind_of(*at) == Kind::kWord) ++at;
    if (at != end && kind_of(*at) == Kind::kSpecial) return split_carefully(text);
    if (at == begin) return;
    words_.emplace_back(begin, static_cast<std::size_t>(at - begin));
  }
}

void TextRows::split_carefully(std::string_view text) {
  words_.clear();
  if (text.find('\0') != std::string_view::npos) fail_at(line_, "a NUL byte in what should be text");
  text = text.substr(0, text.find('#'));
  if (text.find('\r') != std::string_view::npos) {
    fail_at(line_, "a carriage return inside the line: line ends of two kinds");
  }
  text_ = text;
  TextWords words(text);
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) words_.push_back(word);
}

std::string_view TextWords::next() {
  const std::size_t begin = std::min(rest_.find_first_not_of(kBlanks), rest_.size());
  line_ += static_cast<std::uint64_t>(std::count(rest_.data(), rest_.data() + begin, '\n'));
  const std::size_t end = std::min(rest_.find_first_of(kBlanks, begin), rest_.size());
  const std::string_view word = rest_.substr(begin, end - begin);
  rest_.remove_prefix(end);
  return word;
}

void fail_at(std::uint64_t line, const std::string& message) {
  const std::string where = line > 0 ? "line " + std::to_string(line) + ": " : std::string();
  refuse(where + message, line);
}

std::string quoted_excerpt(std::string_view text) {
  std::string shown = "'";
  for (char c : text.substr(0, 40)) shown.push_back(c >= ' ' && c < 127 ? c : '?');
  return shown + (text.size() > 40 ? "...'" : "'");
}

std::string_view first_word(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    if (!text.starts_with('#')) return text.substr(0, text.find_first_of(kBlanks));
    text.remove_prefix(std::min(text.find_first_of("\r\n"), text.size()));
  }
}

bool same_but_for_case(std::string_view a, std::string_view b) {
  const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char c, char d) { return small(c) == small(d); });
}

std::string_view without_blanks(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

std::uint64_t parse_count(std::string_view word, std::uint64_t line, const char* what) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) {
    fail_at(line, std::string(what) + " must be a whole number >= 0, not " + quoted_excerpt(word));
  }
  return value;
}

double parse_number(std::string_view word, std::uint64_t line, const char* what) {
  std::string_view digits = word;
  if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) {
    fail_at(line, std::string(what) + " " + quoted_excerpt(word) + " is outside the range of a double");
  }
  if (error != std::errc{} || end != digits.data() + digits.size() || digits.front() == '+') {
    fail_at(line, std::string(what) + " must be a number, not " + quoted_excerpt(word));
  }
  return value;
}

double parse_finite(std::string_view word, std::uint64_t line, const char* what) {
  const double value = parse_number(word, line, what);
  if (!std::isfinite(value)) {
    fail_at(line, std::string(what) + " " + quoted_excerpt(word) + " is not finite");
  }
  return value;
}

}  // namespace affskel::core
