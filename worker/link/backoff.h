#pragma once

#include <chrono>
#include <cstdint>

#include "core/base/split_mix64.h"

namespace affskel::worker {

/// Exponential backoff with jitter: each pause is twice the one before, up to a longest one, times a random
/// factor of 1/2 to 1, so that workers that failed together do not come back together.
class Backoff {
 public:
  Backoff(std::chrono::milliseconds first, std::chrono::milliseconds longest, std::uint64_t seed)
      : first_(first), longest_(longest), next_(first), random_{seed} {}

  std::chrono::milliseconds next();

  /// To be called after a success: begins again with the first pause.
  void reset() { next_ = first_; }

 private:
  std::chrono::milliseconds first_, longest_, next_;
  core::SplitMix64 random_;
};

}  // namespace affskel::worker
