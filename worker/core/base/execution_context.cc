#include "core/base/execution_context.h"

#include "core/base/error.h"

namespace affskel::core {

void throw_if_stopped(ExecutionContext* context) {
  if (context != nullptr && context->stop_requested()) {
    throw CoreError(CoreError::Code::kCancelled, "stopped before the end");
  }
}

}  // namespace affskel::core
