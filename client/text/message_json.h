#pragma once

#include <google/protobuf/message.h>

#include <nlohmann/json.hpp>

namespace affskel::client {

/// The message with every field under its name in the protocol (snake_case): numbers as numbers, enums as
/// their words (see wire::word; unspecified = null), absent messages left out.
nlohmann::ordered_json to_json(const google::protobuf::Message& message);

}  // namespace affskel::client
