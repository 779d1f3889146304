#pragma once

#include <exception>
#include <functional>
#include <future>
#include <string>
#include <utility>

#include "link/server_link.h"

namespace affskel::worker {

/// The last report of a block on its way to the server, while the next block is computed.  One thread.
class LastReport {
 public:
  /// @param failed called with the lease's token when a report failed although neither the lease was lost nor
  ///   the server gone.
  explicit LastReport(std::function<void(const std::string&, std::exception_ptr)> failed)
      : failed_(std::move(failed)) {}

  /// Starts `send` in the background; what it uses must live until wait() or drop().  Waits for the one
  /// before first.  @throws as wait(); then nothing is started.
  void start(const std::string& token, std::function<void()> send) {
    wait();
    token_ = token;
    sent_ = std::async(std::launch::async, std::move(send));
  }

  /// Waits for the report to be acknowledged, if there is one.
  /// @throws LeaseLost, ServerGone: it was not, and all that was computed since may depend on it.
  void wait() {
    if (!sent_.valid()) return;
    try {
      sent_.get();
    } catch (const LeaseLost&) {
      throw;
    } catch (const ServerGone&) {
      throw;
    } catch (...) {
      failed_(token_, std::current_exception());
      throw LeaseLost("the last report of the block before failed");
    }
  }

  /// The lease of a report that may not be acknowledged yet; empty when there is none.
  std::string token() const { return sent_.valid() ? token_ : std::string(); }

  /// Waits for the report without regard to how it ends.
  void drop() { sent_ = {}; }  // the destructor of what std::async gave waits

 private:
  std::function<void(const std::string&, std::exception_ptr)> failed_;
  std::string token_;
  std::future<void> sent_;
};

}  // namespace affskel::worker
