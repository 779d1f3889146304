#pragma once

#include <chrono>
#include <functional>

#include "core/base/error.h"
#include "core/base/execution_context.h"

namespace affskel::worker {

/// The processor time that all threads of this process have taken together.
std::chrono::nanoseconds processor_time();

/// What is bound, for the message.
struct LimitedWork {
  const char* what;    ///< "making the mesh ready"
  const char* option;  ///< that sets the bound
  const char* cause;   ///< why it may take as long
};
inline constexpr LimitedWork kPreparing = {
    "making the mesh ready", "--prepare-limit",
    "very many surfaces or triangles lie on or across each other, or the lattice is very fine"};
inline constexpr LimitedWork kDeriving = {"making this of the field", "--derive-limit",
                                          "the lattice is very fine"};

/// The context of a task with a bound on its processor time: a small file can ask for days.  Processor time, for a
/// worker that is suspended or shares its cores with others must not fail a job that is as good as any.  Any thread.
class TaskLimit : public core::ExecutionContext {
 public:
  using Clock = std::function<std::chrono::nanoseconds()>;

  /// @param task asked first; must outlive this.
  /// @param limit counted from now; 0: none. @param work must outlive this.
  TaskLimit(core::ExecutionContext& task, std::chrono::seconds limit, const LimitedWork& work,
            Clock clock = processor_time);

  bool stop_requested() override;

  /// What is to be thrown instead of `error`: kLimit, when it was the bound that stopped the computation.
  core::CoreError reason(const core::CoreError& error);

 private:
  bool exceeded() const { return limit_.count() != 0 && clock_() - start_ > limit_; }

  core::ExecutionContext& task_;
  const std::chrono::seconds limit_;
  const LimitedWork& work_;
  const Clock clock_;
  const std::chrono::nanoseconds start_;
};

}  // namespace affskel::worker
