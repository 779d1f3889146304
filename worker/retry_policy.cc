#include "retry_policy.h"

namespace affskel::worker {
namespace {

constexpr RetryPolicy::Duration kFirstPause{20};
constexpr RetryPolicy::Duration kLongestPause{1000};

}  // namespace

RetryPolicy::RetryPolicy(Duration patience, std::uint64_t seed)
    : patience_(patience), backoff_(kFirstPause, kLongestPause, seed) {}

RetryPolicy::Decision RetryPolicy::after(grpc::StatusCode code, Duration elapsed) {
  const Duration pause = backoff_.next();
  switch (code) {
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
      answered_ = elapsed;
      return {Verdict::kAgain, pause};
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::DEADLINE_EXCEEDED:
      return {elapsed + pause > answered_ + patience_ ? Verdict::kServerGone : Verdict::kAgain, pause};
    case grpc::StatusCode::INTERNAL:
    case grpc::StatusCode::UNKNOWN:
      answered_ = elapsed;
      return {elapsed + pause > kTrouble ? Verdict::kFailed : Verdict::kAgain, pause};
    case grpc::StatusCode::ABORTED:
    case grpc::StatusCode::NOT_FOUND:
      return {Verdict::kLeaseLost, {}};
    default:
      return {Verdict::kFailed, {}};
  }
}

}  // namespace affskel::worker
