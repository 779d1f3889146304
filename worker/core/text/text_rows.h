#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace affskel::core {

/// Rows of a text file: lines (LF or CRLF, CR where the bytes have no LF) without `#` comments, blank ones skipped,
/// cut into words.  A byte order mark of UTF-8, which some editors and spreadsheets put first, is passed over.  The
/// bytes must outlive the rows.
class TextRows {
 public:
  /// @param lines_before lines of the file in front of `bytes`, counted by `line` too.
  explicit TextRows(std::string_view bytes, std::uint64_t lines_before = 0)
      : rest_(bytes), line_(lines_before) {
    if (rest_.find('\n') == std::string_view::npos && rest_.find('\r') != std::string_view::npos) end_ = '\r';
    if (lines_before == 0 && rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
  }

  /// Moves on to the next row that holds words; false at the end of the file.
  /// @throws CoreError kBadInput with the line for a NUL byte or a carriage return inside the line.
  bool next();

  std::uint64_t line() const { return line_; }  ///< of the file, counted from 1
  std::size_t bytes_left() const { return rest_.size(); }
  const std::vector<std::string_view>& words() const { return words_; }
  std::string_view text() const { return text_; }  ///< the row, not cut
  void drop_first_word() { words_.erase(words_.begin()); }

 private:
  void split(std::string_view text);
  // Lines with comments or with characters that do not belong into text.
  void split_carefully(std::string_view text);

  std::string_view rest_;
  char end_ = '\n';  // of a line
  std::string_view text_;
  std::uint64_t line_;
  std::vector<std::string_view> words_;
};

/// The words of a text one after the other, however long its lines are, which take no memory.  The bytes must outlive
/// this.
class TextWords {
 public:
  /// @param line of the file that the text begins in, counted from 1.
  explicit TextWords(std::string_view text, std::uint64_t line = 1) : rest_(text), line_(line) {}

  /// The next word; empty at the end.
  std::string_view next();
  std::uint64_t line() const { return line_; }  ///< of the file, that the last word is in

 private:
  std::string_view rest_;
  std::uint64_t line_;
};

/// @throws CoreError kBadInput, always, naming the line if there is one (0 = none).
[[noreturn]] void fail_at(std::uint64_t line, const std::string& message);

/// An excerpt of a file in quotes, for a message: short, and printable whatever the bytes are.
std::string quoted_excerpt(std::string_view text);

/// The first word of a text that TextRows gives, wherever its lines end; empty when there is none.
std::string_view first_word(std::string_view text);

/// Whether two words are the same but for small and capital letters (of ASCII).
bool same_but_for_case(std::string_view a, std::string_view b);

/// The text without blanks and line breaks around it.
std::string_view without_blanks(std::string_view text);

/// @param what names the number in the message. @throws CoreError kBadInput unless it is a whole number >= 0.
std::uint64_t parse_count(std::string_view word, std::uint64_t line, const char* what);

/// @throws CoreError kBadInput unless it is a number within the range of a double; it may be infinite or NaN.
double parse_number(std::string_view word, std::uint64_t line, const char* what);

/// @throws CoreError kBadInput unless it is a finite number.
double parse_finite(std::string_view word, std::uint64_t line, const char* what);

}  // namespace affskel::core
