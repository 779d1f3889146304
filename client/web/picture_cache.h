#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <string>

#include "base/mutex.h"
#include "client/operations/picture.h"

namespace affskel::client {

/// Pictures that were drawn, for later requests; the longest unused leave.  Callers check first that the user
/// may see the job.  Thread-safe.
class PictureCache {
 public:
  /// @param most bytes of all pictures, but for the newest.
  explicit PictureCache(std::uint64_t most) : most_(most) {}

  /// Null when there is none.
  std::shared_ptr<const Picture> find(const std::string& key);
  void put(const std::string& key, std::shared_ptr<const Picture> picture);

 private:
  struct Slot {
    std::string key;
    std::shared_ptr<const Picture> picture;
  };

  const std::uint64_t most_;
  base::Mutex mutex_;
  std::list<Slot> slots_ ABSL_GUARDED_BY(mutex_);  // the last used first
  std::uint64_t bytes_ ABSL_GUARDED_BY(mutex_) = 0;
};

}  // namespace affskel::client
