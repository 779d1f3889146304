#include "client/web/picture_cache.h"

#include <algorithm>
#include <utility>

namespace affskel::client {

std::shared_ptr<const Picture> PictureCache::find(const std::string& key) {
  const base::MutexLock lock(mutex_);
  const auto found =
      std::find_if(places_.begin(), places_.end(), [&](const Place& place) { return place.key == key; });
  if (found == places_.end()) return nullptr;
  places_.splice(places_.begin(), places_, found);
  return found->picture;
}

void PictureCache::put(const std::string& key, std::shared_ptr<const Picture> picture) {
  const base::MutexLock lock(mutex_);
  bytes_ += picture->png.size();
  places_.push_front({key, std::move(picture)});
  while (bytes_ > most_ && places_.size() > 1) {
    bytes_ -= places_.back().picture->png.size();
    places_.pop_back();
  }
}

}  // namespace affskel::client
