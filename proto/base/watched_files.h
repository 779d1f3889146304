#pragma once

#include <sys/types.h>

#include <ctime>
#include <string>
#include <vector>

namespace affskel::base {

/// Files that may be replaced while a program uses what they held.  Not thread-safe.
class WatchedFiles {
 public:
  /// @param paths empty ones are passed over.
  explicit WatchedFiles(std::vector<std::string> paths);

  /// Whether one of them was replaced or changed, came or went since the last look, or the construction.
  bool changed();

 private:
  /// Zeros when the file is not there.
  struct Stamp {
    ino_t number = 0;
    off_t size = 0;
    time_t seconds = 0;
    long nanoseconds = 0;
    bool operator==(const Stamp&) const = default;
  };
  std::vector<Stamp> look() const;

  std::vector<std::string> paths_;
  std::vector<Stamp> seen_;
};

}  // namespace affskel::base
