#pragma once

#include <google/protobuf/message_lite.h>

#include <cstdint>
#include <string>

#include "wire/limits.h"

namespace affskel::worker {

/// Appends the serialized message to a result.
/// @param what names the message for people, with a hint: "the directions; take fewer of them".
/// @throws core::CoreError kLimit when the result would have more than `limit` bytes.
void append_result(std::string& result, const google::protobuf::MessageLite& message, const std::string& what,
                   std::uint64_t limit = wire::kMaxResultBytes);

}  // namespace affskel::worker
