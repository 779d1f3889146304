#pragma once

#include <google/protobuf/descriptor.h>
#include <google/protobuf/generated_enum_reflection.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace affskel::wire {

/// The word for a value of one of the protocol's enumerations, everywhere: in the database, in logs, on the
/// command line, in JSON.  It is the value's name without the type's prefix, in lower case, with `-` for `_`
/// (TASK_KIND_ERODED_POINTS: "eroded-points"); empty for "unspecified".
std::string word(const google::protobuf::EnumValueDescriptor& value);

/// All words of a type, in the protocol's order.
std::vector<std::string> words(const google::protobuf::EnumDescriptor& type);

/// The number of the value with this word.
std::optional<int> number_of_word(const google::protobuf::EnumDescriptor& type, std::string_view word);

/// Empty for "unspecified" and for a number that the protocol does not know.
template <typename Enum>
std::string word(Enum value) {
  const auto* known = google::protobuf::GetEnumDescriptor<Enum>()->FindValueByNumber(static_cast<int>(value));
  return known == nullptr ? std::string() : word(*known);
}

template <typename Enum>
std::optional<Enum> value_of_word(std::string_view text) {
  const std::optional<int> number = number_of_word(*google::protobuf::GetEnumDescriptor<Enum>(), text);
  return number ? std::optional(static_cast<Enum>(*number)) : std::nullopt;
}

}  // namespace affskel::wire
