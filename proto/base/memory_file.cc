#include "base/memory_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>

#include "base/file_error.h"

namespace affskel::base {
namespace {

constexpr const char* kAction = "cannot be kept in memory";

int filled(const std::string& name, std::string_view bytes) {
  const int fd = memfd_create("affskel", MFD_CLOEXEC);
  if (fd < 0) throw FileError(errno, kAction, name);
  if (write(fd, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size())) return fd;
  const int error = errno;
  close(fd);
  throw FileError(error, kAction, name);
}

}  // namespace

MemoryFile::MemoryFile(const std::string& name, std::string_view bytes)
    : name_(name), fd_(filled(name, bytes)), path_("/proc/self/fd/" + std::to_string(fd_)) {}

MemoryFile::~MemoryFile() {
  close(fd_);
}

void MemoryFile::replace(std::string_view bytes) {
  const int fd = filled(name_, bytes);
  const int result = dup3(fd, fd_, O_CLOEXEC);  // in one step: the path is never without a file
  const int error = errno;
  close(fd);
  if (result < 0) throw FileError(error, kAction, name_);
}

}  // namespace affskel::base
