#pragma once

#include <google/protobuf/message_lite.h>

#include <cstdint>
#include <string>

namespace affskel::worker {

/// What the server takes as the result of one task, and what Protobuf can serialize: 2^31 - 1 bytes.
inline constexpr std::uint64_t kMaxResultBytes = (std::uint64_t{1} << 31) - 1;

/// Appends the serialized message to a result.
/// @param what names the message for people, with a hint: "the directions; take fewer of them".
/// @throws core::CoreError kLimit when the result would have more than `limit` bytes.
void append_result(std::string& result, const google::protobuf::MessageLite& message, const std::string& what,
                   std::uint64_t limit = kMaxResultBytes);

}  // namespace affskel::worker
