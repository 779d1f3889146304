#include "base/read_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>

namespace affskel::base {
namespace {

constexpr std::uint64_t kStep = std::uint64_t{1} << 20;

class Descriptor {
 public:
  explicit Descriptor(const std::string& path) : fd_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (fd_ < 0) throw FileError(errno, "cannot open", path);
  }
  ~Descriptor() { close(fd_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  const int fd_;
};

/// As far as it is known: 0 of a pipe.
std::uint64_t size_of(int fd) {
  struct stat status {};
  if (fstat(fd, &status) != 0 || !S_ISREG(status.st_mode) || status.st_size < 0) return 0;
  return static_cast<std::uint64_t>(status.st_size);
}

}  // namespace

std::string read_file(const std::string& path, std::uint64_t max_bytes) {
  const Descriptor file(path);
  std::string bytes;
  bytes.reserve(std::min(size_of(file.get()), max_bytes) + 1);
  while (bytes.size() <= max_bytes) {
    const std::size_t before = bytes.size();
    const std::uint64_t room = std::max<std::uint64_t>(1, std::min(kStep, bytes.capacity() - before));
    bytes.resize(before + std::min(room, max_bytes + 1 - before));
    const ssize_t got = read(file.get(), bytes.data() + before, bytes.size() - before);
    if (got < 0 && errno != EINTR) throw FileError(errno, "cannot read", path);
    bytes.resize(before + static_cast<std::size_t>(std::max<ssize_t>(0, got)));
    if (got == 0) break;
  }
  return bytes;
}

}  // namespace affskel::base
