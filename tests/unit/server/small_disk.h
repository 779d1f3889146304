#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <string>

namespace affskel::server {

/// Lets SQLite believe that a directory is a small disk of its own: files there cannot grow past a common
/// limit.  One at a time.
class SmallDisk {
 public:
  explicit SmallDisk(const std::string& directory);
  ~SmallDisk();
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  /// Bytes of all files.
  std::uint64_t used() const;
  std::uint64_t free() const;

  /// Others write so much that only this is left.
  void leave(std::uint64_t bytes);

  /// Whether the calling thread was refused room here.
  bool refused_this_thread() const;

 private:
  sqlite3_vfs* vfs_;
  int number_;  // of the disks of this process, from 1
};

}  // namespace affskel::server
