#include "link/retry_policy.h"

namespace affskel::worker {
namespace {

constexpr RetryPolicy::Duration kFirstPause{20};
constexpr RetryPolicy::Duration kMaxPause{1000};

}  // namespace

std::chrono::seconds call_timeout(std::uint64_t bytes) {
  constexpr std::uint64_t kLeastBytesPerSecond = 1024;
  return std::chrono::seconds(120 + static_cast<std::int64_t>(bytes / kLeastBytesPerSecond));
}

RetryPolicy::RetryPolicy(Duration patience, std::uint64_t seed)
    : patience_(patience), backoff_(kFirstPause, kMaxPause, seed) {}

RetryPolicy::Decision RetryPolicy::after(grpc::StatusCode code, Duration elapsed, bool connected) {
  const Duration pause = backoff_.next();
  switch (code) {
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
      answered_ = elapsed;
      return {Verdict::kAgain, pause};
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::CANCELLED:
    case grpc::StatusCode::DEADLINE_EXCEEDED:
      if (connected && code != grpc::StatusCode::DEADLINE_EXCEEDED) answered_ = elapsed;
      return {elapsed + pause > answered_ + patience_ ? Verdict::kServerGone : Verdict::kAgain, pause};
    case grpc::StatusCode::INTERNAL:
    case grpc::StatusCode::UNKNOWN:
      answered_ = elapsed;
      return {elapsed + pause > kTrouble ? Verdict::kFailed : Verdict::kAgain, pause};
    case grpc::StatusCode::ABORTED:
    case grpc::StatusCode::NOT_FOUND:
    case grpc::StatusCode::DATA_LOSS:  // a stored input is damaged, and the server has failed the task itself
      return {Verdict::kLeaseLost, {}};
    default:
      return {Verdict::kFailed, {}};
  }
}

}  // namespace affskel::worker
