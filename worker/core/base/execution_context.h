#pragma once

#include <cstdint>

#include "core/base/error.h"

namespace affskel::core {

/// Passed into long computations: they ask it at short intervals whether to stop, and tell it what is
/// finished.  Called from several threads at once.
class ExecutionContext {
 public:
  virtual ~ExecutionContext() = default;

  /// Whether to stop as soon as possible; what is finished stays valid.
  virtual bool stop_requested() { return false; }

  /// Work item `item` (its place in the list given) is finished and its results are in the field.
  virtual void item_done(std::uint64_t item) { static_cast<void>(item); }
};

/// For computations that are all or nothing.
/// @param context may be null: it is never stopped. @throws CoreError kCancelled when it asks to stop.
inline void throw_if_stopped(ExecutionContext* context) {
  if (context != nullptr && context->stop_requested())
    throw CoreError(CoreError::Code::kCancelled, "stopped before the end");
}

/// throw_if_stopped for loops whose rounds are too short to ask in each of them: asks about once a
/// millisecond.  Used by one thread; several threads each have their own.
class StopCheck {
 public:
  explicit StopCheck(ExecutionContext* context) : context_(context) {}

  /// @param operations done since the last call, of some nanoseconds each.
  void did(std::uint64_t operations) {
    done_ += operations;
    if (done_ < kOperations) return;
    done_ = 0;
    throw_if_stopped(context_);
  }

 private:
  static constexpr std::uint64_t kOperations = 1 << 16;

  ExecutionContext* context_;
  std::uint64_t done_ = 0;
};

}  // namespace affskel::core
