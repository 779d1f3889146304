#pragma once

#include <cstdint>

namespace affskel::core {

/// Passed into long computations: they ask it between directions whether to stop, and tell it what is
/// finished.  Called from several threads at once.
class ExecutionContext {
 public:
  virtual ~ExecutionContext() = default;

  /// Whether to stop as soon as possible; what is finished stays valid.
  virtual bool stop_requested() { return false; }

  /// Work item `item` (its place in the list given) is finished and its results are in the field.
  virtual void item_done(std::uint64_t item) { static_cast<void>(item); }
};

}  // namespace affskel::core
