#pragma once

#include <functional>
#include <future>

namespace affskel::worker {

/// The last report of a block on its way to the server, while the next block is computed.  One thread.
class LastReport {
 public:
  /// Starts `send` in the background; what it uses must live until wait() or drop().  Waits for the one
  /// before first.  @throws what that one threw; then nothing is started.
  void start(std::function<void()> send) {
    wait();
    sent_ = std::async(std::launch::async, std::move(send));
  }

  /// Waits for the report to be acknowledged, if there is one.  @throws LeaseLost, ServerGone: it was not,
  /// and all that was computed since may depend on it.
  void wait() {
    if (sent_.valid()) sent_.get();
  }

  /// Waits for the report without regard to how it ends.
  void drop() { sent_ = {}; }  // the destructor of what std::async gave waits

 private:
  std::future<void> sent_;
};

}  // namespace affskel::worker
