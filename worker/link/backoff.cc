#include "link/backoff.h"

#include <algorithm>

namespace affskel::worker {

std::chrono::milliseconds Backoff::next() {
  const std::chrono::milliseconds most = next_;
  next_ = std::min(2 * next_, longest_);
  const auto half = static_cast<std::uint64_t>(most.count() / 2);
  return most - std::chrono::milliseconds(random_.next() % (half + 1));
}

}  // namespace affskel::worker
