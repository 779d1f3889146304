#pragma once

#include <google/protobuf/message.h>

#include <nlohmann/json.hpp>

namespace affskel::client {

/// The message with every field under its name in the protocol (snake_case): numbers as numbers, enums as
/// short lower-case words ("done", "erode", "zucker-hummel"; unspecified = null), absent messages left out.
nlohmann::ordered_json to_json(const google::protobuf::Message& message);

/// The short word for an enum value: its name without the type's prefix, lower-case, `-` for `_`; empty for
/// unspecified.
std::string enum_word(const google::protobuf::EnumValueDescriptor& value);

}  // namespace affskel::client
