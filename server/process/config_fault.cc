#include "process/config_fault.h"

#include <cctype>
#include <fstream>
#include <string_view>

namespace affskel::server {
namespace {

constexpr std::string_view kUnread = "INI was not able to parse ";
constexpr std::string_view kSection = ".++";  // CLI11's mark of where one begins

std::string without_blanks(const std::string& line) {
  std::string text;
  for (const char c : line)
    if (std::isspace(static_cast<unsigned char>(c)) == 0) text += c;
  return text;
}

/// "line 3: " of the first line that begins with this; empty where there is none.
std::string place_of(const std::string& file, const std::string& start) {
  std::ifstream in(file);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number)
    if (without_blanks(line).starts_with(start)) return "line " + std::to_string(number) + ": ";
  return {};
}

}  // namespace

std::string config_fault(const std::string& file, const std::string& error) {
  if (!error.starts_with(kUnread)) return file + ": " + error;
  std::string word = without_blanks(error.substr(kUnread.size()));
  if (word.ends_with(kSection)) {
    word.resize(word.size() - kSection.size());
    return file + ": " + place_of(file, "[" + word + "]") + "unknown section '" + word +
           "'; options stand in none";
  }
  return file + ": " + place_of(file, word + "=") + "unknown option '" + word + "'";
}

}  // namespace affskel::server
