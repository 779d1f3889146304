#include "base/watched_files.h"

#include <sys/stat.h>

#include <utility>

namespace affskel::base {

WatchedFiles::WatchedFiles(std::vector<std::string> paths) : paths_(std::move(paths)), seen_(look()) {}

bool WatchedFiles::changed() {
  std::vector<Stamp> now = look();
  if (now == seen_) return false;
  seen_ = std::move(now);
  return true;
}

std::vector<WatchedFiles::Stamp> WatchedFiles::look() const {
  std::vector<Stamp> stamps;
  for (const std::string& path : paths_) {
    struct stat status {};
    if (path.empty() || stat(path.c_str(), &status) != 0) status = {};
    stamps.push_back({status.st_ino, status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec});
  }
  return stamps;
}

}  // namespace affskel::base
