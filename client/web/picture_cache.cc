#include "client/web/picture_cache.h"

#include <algorithm>
#include <utility>

namespace affskel::client {

std::shared_ptr<const Picture> PictureCache::find(const std::string& key) {
  const base::MutexLock lock(mutex_);
  const auto found =
      std::find_if(slots_.begin(), slots_.end(), [&](const Slot& slot) { return slot.key == key; });
  if (found == slots_.end()) return nullptr;
  slots_.splice(slots_.begin(), slots_, found);
  return found->picture;
}

void PictureCache::put(const std::string& key, std::shared_ptr<const Picture> picture) {
  const base::MutexLock lock(mutex_);
  bytes_ += picture->png.size();
  slots_.push_front({key, std::move(picture)});
  while (bytes_ > most_ && slots_.size() > 1) {
    bytes_ -= slots_.back().picture->png.size();
    slots_.pop_back();
  }
}

}  // namespace affskel::client
