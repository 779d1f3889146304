#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

#include "scene.h"

namespace affskel::chaos {

/// A client that submits and follows small jobs all the time, half of them by way of the proxy.  It repeats
/// what was not acknowledged, with the same request id.
class Load {
 public:
  explicit Load(Scene& scene);
  ~Load();

  /// Returns when no call is under way; none begins before resume().
  void pause();
  void resume();

 private:
  void work();
  void step();
  bool may_go();

  Scene& scene_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool paused_ = true, busy_ = false, stop_ = false;
  Submission open_;  // not acknowledged yet; no name = none
  std::uint64_t steps_ = 0;
  std::thread thread_;
};

}  // namespace affskel::chaos
