#pragma once

#include <grpcpp/support/status.h>

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "link/backoff.h"

namespace affskel::worker {

/// How long a call may take that moves so many bytes: a server that says nothing is given up after two minutes, and one
/// that moves less than 1 KiB a second ends the call itself.
std::chrono::seconds call_timeout(std::uint64_t bytes);

/// Whether, and after which pause, a call that ended with an error is made again.  One call of one task.
class RetryPolicy {
 public:
  using Duration = std::chrono::milliseconds;

  enum class Verdict {
    kAgain,
    kLeaseLost,   ///< ABORTED, NOT_FOUND, DATA_LOSS: the task is not ours any more
    kFailed,      ///< the call cannot succeed; the task failed, and may be tried elsewhere
    kServerGone,  ///< it did not answer for as long as patience lasts
  };

  struct Decision {
    Verdict verdict = Verdict::kAgain;
    Duration pause{0};  ///< before the call is made again
  };

  /// How long a server that answers with errors of its own (INTERNAL, UNKNOWN) is asked again before the task
  /// fails: passing trouble such as too many open files must not use up a job's attempts.
  static constexpr Duration kTrouble{30000};

  RetryPolicy(Duration patience, std::uint64_t seed);

  /// The server has taken or sent something of the call, so long after it was first made.
  void heard(Duration elapsed) { answered_ = std::max(answered_, elapsed); }

  /// A server that closes ends calls with UNAVAILABLE or CANCELLED: both mean "again", until patience has
  /// passed without an answer.  A server that is full (RESOURCE_EXHAUSTED), or says itself that it cannot
  /// answer now, has answered: it is asked without end.
  /// @param code of a call that this side did not cancel.
  /// @param elapsed since the call was first made.
  /// @param connected whether the connection stands, so that the status is the server's own word.
  Decision after(grpc::StatusCode code, Duration elapsed, bool connected);

 private:
  Duration patience_;
  Duration answered_{0};  // when the server was last heard at all
  Backoff backoff_;
};

}  // namespace affskel::worker
