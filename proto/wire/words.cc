#include "wire/words.h"

#include <cctype>

namespace affskel::wire {

std::string word(const google::protobuf::EnumValueDescriptor& value) {
  if (value.number() == 0) return {};
  // JobState's values begin with JOB_STATE_: one underscore more per capital letter inside the type's name.
  std::size_t prefix = 1;
  const std::string& type = value.type()->name();
  for (std::size_t i = 0; i < type.size(); ++i) {
    prefix += i > 0 && std::isupper(static_cast<unsigned char>(type[i])) ? 2 : 1;
  }
  std::string text = value.name().substr(prefix);
  for (char& c : text) c = c == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::vector<std::string> words(const google::protobuf::EnumDescriptor& type) {
  std::vector<std::string> all;
  for (int i = 0; i < type.value_count(); ++i) {
    if (type.value(i)->number() != 0) all.push_back(word(*type.value(i)));
  }
  return all;
}

std::optional<int> number_of_word(const google::protobuf::EnumDescriptor& type, std::string_view text) {
  for (int i = 0; i < type.value_count(); ++i) {
    if (type.value(i)->number() != 0 && word(*type.value(i)) == text) return type.value(i)->number();
  }
  return std::nullopt;
}

}  // namespace affskel::wire
