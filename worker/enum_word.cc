#include "enum_word.h"

namespace affskel::worker {

std::string enum_word(std::string_view value_name, std::string_view prefix) {
  if (!value_name.starts_with(prefix)) return {};
  std::string word;
  for (const char c : value_name.substr(prefix.size())) {
    word.push_back(c == '_' ? '-' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c);
  }
  return word;
}

}  // namespace affskel::worker
