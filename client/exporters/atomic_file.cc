#include "client/exporters/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <vector>

#include "client/error.h"
#include "client/interrupt.h"

namespace affskel::client {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

// What open(2) would have given a new file.
mode_t default_mode() {
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

// Where a symbolic link leads that points to no file yet: open(2) would make that file.
fs::path follow_dangling(fs::path path) {
  constexpr int kMostLinks = 40;  // as the kernel
  std::error_code error;
  for (int links = 0; fs::is_symlink(fs::symlink_status(path, error)); ++links) {
    if (links == kMostLinks) throw error_from_errno(ELOOP, "cannot write", path);
    const fs::path to = fs::read_symlink(path, error);
    if (error) throw error_from_errno(error.value(), "cannot write", path);
    path = path.parent_path() / to;  // absolute targets replace the whole
  }
  return path;
}

void sync_directory(const fs::path& directory) {
  const int fd = open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;  // some file systems do not let directories be opened; the file itself is safe
  fsync(fd);
  close(fd);
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target) : target_(target) {
  struct stat info {};
  const bool exists = stat(target.c_str(), &info) == 0;
  if (!exists && errno != ENOENT) fail("cannot write");
  if (exists && S_ISDIR(info.st_mode)) throw ClientError(ExitCode::kUsage, "is a directory", target);
  if (exists && !S_ISREG(info.st_mode)) {
    regular_ = false;
    path_ = target;
    fd_ = open(target.c_str(), O_WRONLY | O_CLOEXEC);
    if (fd_ < 0) fail("cannot write");
    return;
  }
  std::error_code error;
  if (exists) target_ = fs::canonical(target, error);
  if (error) target_ = target;
  if (!exists) target_ = follow_dangling(target);
  const fs::path directory = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
  // Not after the target: its name may be as long as names can be.
  std::string name = (directory / ".affskel.XXXXXX").string();
  fd_ = mkostemp(name.data(), O_CLOEXEC);
  if (fd_ < 0) fail("cannot write");
  path_ = name;
  guard_temporary_file(name);
  fchmod(fd_, exists ? info.st_mode & 07777 : default_mode());
}

AtomicFile::~AtomicFile() {
  if (fd_ >= 0) close(fd_);
  if (!regular_ || committed_) return;
  unlink(path_.c_str());
  release_temporary_file(path_.string());
}

void AtomicFile::fail(const char* action) const {
  throw error_from_errno(errno, action, target_);
}

void AtomicFile::write(std::string_view bytes) {
  buffer_.append(bytes);
  if (buffer_.size() >= kBufferBytes) flush();
}

void AtomicFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t written = ::write(fd_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot write");
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void AtomicFile::sync() {
  flush();
  if (regular_ && fsync(fd_) != 0) fail("cannot write");
}

void AtomicFile::commit() {
  sync();
  if (regular_) {
    if (rename(path_.c_str(), target_.c_str()) != 0) fail("cannot rename the finished file");
    committed_ = true;
    release_temporary_file(path_.string());
    sync_directory(target_.has_parent_path() ? target_.parent_path() : fs::path("."));
  }
  const int fd = fd_;
  fd_ = -1;
  if (close(fd) != 0) fail("cannot write");
}

}  // namespace affskel::client
