#include "job/result_bytes.h"

#include "core/base/error.h"

namespace affskel::worker {

void append_result(std::string& result, const google::protobuf::MessageLite& message, const std::string& what,
                   std::uint64_t limit) {
  const std::uint64_t bytes = result.size() + message.ByteSizeLong();
  if (bytes > limit) {
    throw core::CoreError(core::CoreError::Code::kLimit, "the result would have " + std::to_string(bytes) +
                                                             " bytes with " + what + "; at most " +
                                                             std::to_string(limit) + " can be handed in");
  }
  if (!message.AppendToString(&result)) {
    throw core::CoreError(core::CoreError::Code::kInternal, "cannot serialize " + what);
  }
}

}  // namespace affskel::worker
