#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace affskel::core {

/// Fields of a header in text, each with its line; names in small letters.
class VoxelHeader {
 public:
  void set(std::string_view name, std::string_view value, std::uint64_t line);
  bool has(const char* name) const { return fields_.contains(name); }
  std::string word(const char* name, const char* usual = "") const;
  std::uint64_t line(const char* name) const;  ///< 0 where there is no such field
  /// All words of a field; parentheses and commas part them, too.
  std::vector<std::string> words(const char* name) const;
  /// These as numbers.
  /// @throws CoreError kBadInput with the line.
  std::vector<double> numbers(const char* name) const;
  std::vector<double> numbers(const char* name, std::size_t count) const;
  /// Three of a field that has a word for each of `axes`, or three alone: those from `first` on.  What the others say,
  /// which are of one item, does not matter (spacings are NaN there).
  std::vector<double> three_numbers(const char* name, std::size_t axes, std::size_t first = 0) const;

 private:
  struct Field {
    std::string value;
    std::uint64_t line;
  };
  std::map<std::string, Field, std::less<>> fields_;
};

/// Gives the lines of a header to `take`, up to one of which this says false or to the end of the bytes; returns what is
/// behind that.
/// @throws CoreError kBadInput for a line of more than 65,536 bytes, and for more than 10,000 lines.
std::string_view read_header_lines(
    std::string_view bytes, const std::function<bool(std::string_view text, std::uint64_t line)>& take);

}  // namespace affskel::core
