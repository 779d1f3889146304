#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace affskel::server {

/// Bytes free for this user on the file system of a directory; the greatest number when that is not known.
std::uint64_t free_bytes(const std::string& directory);

/// A file that only takes room, so that there is some to give away when the disk is full.  Not thread-safe.
class DiskReserve {
 public:
  /// How free space is found: free_bytes, but for tests.
  using FreeBytes = std::function<std::uint64_t(const std::string& directory)>;

  /// Makes the file; on a disk that has next to nothing left, gives it away at once, because the first thing
  /// that a server does is to write.
  /// @param directory where `reserve` lies.
  DiskReserve(const std::string& directory, std::uint64_t bytes, FreeBytes free);

  bool whole() const { return whole_; }

  /// Makes the file anew when there is room for it and a quarter more, so that it does not take the last;
  /// returns whether it is whole.
  bool restore();

  /// Free bytes from which on restore() tries it.
  std::uint64_t wanted() const;

  /// Gives the room away.
  void release();

  /// Lets restore() try again with as much free space as the last time.  For when something large was written
  /// since, or need not be written any more.
  void allow_retry() { not_enough_ = 0; }

 private:
  bool allocate() const;

  std::string directory_;
  std::string file_;
  std::uint64_t bytes_;
  FreeBytes free_;
  bool whole_ = false;
  // Free space at the last restore(); 0 once something large was written.  If the reserve is needed again at
  // once, this much was too little, and trying it again would only write for nothing.
  std::uint64_t not_enough_ = 0;
};

}  // namespace affskel::server
