#include "client/files/read/read_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <system_error>

namespace affskel::client {
namespace {

class OpenFile {
 public:
  explicit OpenFile(const std::string& path) : fd_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~OpenFile() {
    if (fd_ >= 0) close(fd_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

ClientError too_large(const std::string& path, std::uint64_t max_bytes) {
  return {ExitCode::kLimit, "is larger than " + std::to_string(max_bytes) + " bytes", path};
}

[[noreturn]] void unreadable(const std::string& path) {
  if (errno == EBADF) throw ClientError(ExitCode::kUsage, "is closed", path);
  if (errno == EISDIR) throw ClientError(ExitCode::kBadInput, "is a folder; name a file in it", path);
  throw ClientError(ExitCode::kBadInput, "cannot read: " + std::system_category().message(errno), path);
}

// Reads up to one byte more than is allowed: the announced size at once, of what comes beyond it pieces that
// double.
std::string read_all(int fd, const std::string& path, std::uint64_t announced, std::uint64_t max_bytes) {
  constexpr std::uint64_t kMinStep = 1 << 16;
  std::string bytes;
  std::uint64_t size = 0;
  for (std::uint64_t room = std::max(announced + 1, kMinStep);;) {
    room = std::min(room, max_bytes + 1);
    bytes.resize(room);
    const ssize_t got = read(fd, bytes.data() + size, room - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) unreadable(path);
    if (got == 0) break;
    size += static_cast<std::uint64_t>(got);
    if (size > max_bytes) throw too_large(path, max_bytes);
    if (size == room) room = size + std::max(size, kMinStep);
  }
  bytes.resize(size);
  return bytes;
}

std::string read_open(int fd, const std::string& path, std::uint64_t max_bytes) {
  struct stat info {};
  if (fstat(fd, &info) != 0) unreadable(path);
  if (S_ISREG(info.st_mode) && static_cast<std::uint64_t>(info.st_size) > max_bytes)
    throw too_large(path, max_bytes);
  const std::uint64_t announced = S_ISREG(info.st_mode) ? static_cast<std::uint64_t>(info.st_size) : 0;
  try {
    return read_all(fd, path, announced, max_bytes);
  } catch (const std::bad_alloc&) {
    throw out_of_memory(path);
  }
}

}  // namespace

ClientError out_of_memory(const std::string& path) {
  return {ExitCode::kLimit, "not enough memory to read it", path};
}

std::string read_file(const std::string& path, std::uint64_t max_bytes) {
  const OpenFile file(path);
  if (file.fd() < 0) unreadable(path);
  return read_open(file.fd(), path, max_bytes);
}

std::string read_standard_input(const std::string& name, std::uint64_t max_bytes) {
  return read_open(STDIN_FILENO, name, max_bytes);
}

}  // namespace affskel::client
