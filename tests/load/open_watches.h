#pragma once

#include <memory>
#include <string>
#include <vector>

#include "calls.h"

namespace affskel::load {

/// WatchJob streams that stay open until this is destroyed, as of many terminals and pages left open.
class OpenWatches {
 public:
  /// @param ids jobs to watch, in turn.  @param number of streams, forty to a connection.
  /// @param calls has a "watch" for each: until its first message; and its failure, when it ends by itself.
  OpenWatches(const std::string& address, const std::vector<std::string>& ids, int number, Calls& calls);
  ~OpenWatches();
  OpenWatches(const OpenWatches&) = delete;
  OpenWatches& operator=(const OpenWatches&) = delete;

 private:
  class Watch;
  std::vector<std::unique_ptr<v1::ErosionService::Stub>> stubs_;
  std::vector<std::unique_ptr<Watch>> watches_;
};

}  // namespace affskel::load
