#include "database/disk_reserve.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace affskel::server {
namespace {

// For the log's header, its index, server.json, a migration and a first commit.
constexpr std::uint64_t kNextToNothing = std::uint64_t{4} << 20;

constexpr std::uint64_t kGain = std::uint64_t{1} << 20;

constexpr std::uint64_t kStatBlock = 512;

}  // namespace

std::uint64_t free_bytes(const std::string& directory) {
  struct statvfs status {};
  if (statvfs(directory.c_str(), &status) != 0) return std::numeric_limits<std::uint64_t>::max();
  return std::uint64_t{status.f_bavail} * status.f_frsize;
}

DiskReserve::DiskReserve(const std::string& directory, std::uint64_t bytes, FreeBytes free)
    : directory_(directory), file_(directory + "/reserve"), bytes_(bytes), free_(std::move(free)) {
  struct stat status {};
  // A sparse file, as in a copied data directory, would reserve nothing.
  whole_ = stat(file_.c_str(), &status) == 0 && static_cast<std::uint64_t>(status.st_size) == bytes_ &&
           static_cast<std::uint64_t>(status.st_blocks) * kStatBlock >= bytes_;
  if (!whole_) {
    release();
    restore();
    allow_retry();
  } else if (free_(directory_) < kNextToNothing) {
    release();
  }
}

bool DiskReserve::allocate() const {
  const int fd = open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (fd < 0) return false;
  // Writes the blocks itself where the file system cannot.
  const bool done = bytes_ == 0 || posix_fallocate(fd, 0, static_cast<off_t>(bytes_)) == 0;
  close(fd);
  return done;
}

bool DiskReserve::restore() {
  if (whole_) return true;
  const std::uint64_t free = free_(directory_);
  if (free < wanted()) return false;
  not_enough_ = free;
  whole_ = allocate();
  if (!whole_) unlink(file_.c_str());
  return whole_;
}

std::uint64_t DiskReserve::wanted() const {
  return std::max(bytes_ + bytes_ / 4, not_enough_ == 0 ? 0 : not_enough_ + kGain);
}

void DiskReserve::release() {
  whole_ = false;
  unlink(file_.c_str());
}

}  // namespace affskel::server
