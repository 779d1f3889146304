#include "small_disk.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <limits>

namespace affskel::server {
namespace {

// SQLite's calls carry no context.
std::string disk_directory;
std::atomic<std::uint64_t> capacity = 0;
std::atomic<int> disks = 0;
thread_local int last_refusal = 0;  // the number of the disk

std::uint64_t used_bytes() {
  std::uint64_t used = 0;
  for (const auto& entry : std::filesystem::directory_iterator(disk_directory)) {
    std::error_code gone;
    if (entry.is_regular_file(gone)) used += entry.file_size(gone);
  }
  return used;
}

bool has_room(int fd, off_t end) {
  struct stat status {};
  if (fstat(fd, &status) != 0 || end <= status.st_size) return true;
  if (used_bytes() + static_cast<std::uint64_t>(end - status.st_size) <= capacity) return true;
  last_refusal = disks;
  return false;
}

ssize_t pwrite_in_room(int fd, const void* bytes, size_t count, off_t offset) {
  if (has_room(fd, offset + static_cast<off_t>(count))) return pwrite(fd, bytes, count, offset);
  errno = ENOSPC;
  return -1;
}

int fallocate_in_room(int fd, off_t offset, off_t length) {
  return has_room(fd, offset + length) ? posix_fallocate(fd, offset, length) : ENOSPC;
}

}  // namespace

SmallDisk::SmallDisk(const std::string& directory) : vfs_(sqlite3_vfs_find(nullptr)), number_(++disks) {
  disk_directory = directory;
  capacity = std::numeric_limits<std::uint64_t>::max();
  for (const char* name : {"pwrite", "pwrite64"}) {
    vfs_->xSetSystemCall(vfs_, name, reinterpret_cast<sqlite3_syscall_ptr>(pwrite_in_room));
  }
  vfs_->xSetSystemCall(vfs_, "fallocate", reinterpret_cast<sqlite3_syscall_ptr>(fallocate_in_room));
}

SmallDisk::~SmallDisk() {
  vfs_->xSetSystemCall(vfs_, nullptr, nullptr);
}

std::uint64_t SmallDisk::used() const {
  return used_bytes();
}

std::uint64_t SmallDisk::free() const {
  return capacity - std::min<std::uint64_t>(capacity, used_bytes());
}

void SmallDisk::leave(std::uint64_t bytes) {
  capacity = used_bytes() + bytes;
}

bool SmallDisk::refused_this_thread() const {
  return last_refusal == number_;
}

}  // namespace affskel::server
