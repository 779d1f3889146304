#pragma once

#include <algorithm>
#include <chrono>

namespace affskel::server {

struct TokenBucketOptions {
  double burst;  ///< tokens in a full bucket
  double per_s;  ///< that come back each second
};

/// How much a peer may ask for at once, and for long.  Full at first.  Not thread-safe.
class TokenBucket {
 public:
  using Time = std::chrono::steady_clock::time_point;

  TokenBucket(const TokenBucketOptions& options, Time now)
      : options_(options), tokens_(options.burst), since_(now) {}

  /// Takes tokens, more than there are if need be.
  /// @return how long to wait until what was taken is there; zero when it is.
  std::chrono::steady_clock::duration take(double tokens, Time now) {
    tokens_ = refilled(now) - tokens;
    since_ = now;
    if (tokens_ >= 0) return {};
    return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(-tokens_ / options_.per_s));
  }

  /// What is not there again yet.
  double taken(Time now) const { return options_.burst - refilled(now); }

 private:
  double refilled(Time now) const {
    const double passed = std::max(0.0, std::chrono::duration<double>(now - since_).count());
    return std::min(options_.burst, tokens_ + passed * options_.per_s);
  }

  TokenBucketOptions options_;
  double tokens_;
  Time since_;
};

}  // namespace affskel::server
