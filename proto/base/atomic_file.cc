#include "base/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <string>

#include "base/directory.h"
#include "base/standard_streams.h"
#include "base/temporary_files.h"

namespace affskel::base {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

// The process's umask.  umask(2) tells it only by setting another, which another thread's new file would get, and
// two threads that do so at a time would leave.
mode_t read_umask() {
  constexpr mode_t kUsual = 022;  // where /proc is not mounted
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("Umask:")) return static_cast<mode_t>(std::strtoul(line.c_str() + 6, nullptr, 8));
  }
  return kUsual;
}

// What open(2) would have given a new file.
mode_t default_mode() {
  return 0666 & ~read_umask();
}

// Where a symbolic link leads that points to no file yet: open(2) would make that file.
fs::path follow_dangling(fs::path path) {
  constexpr int kMaxLinks = 40;  // as the kernel
  std::error_code error;
  for (int links = 0; fs::is_symlink(fs::symlink_status(path, error)); ++links) {
    if (links == kMaxLinks) throw FileError(ELOOP, "cannot write", path);
    const fs::path to = fs::read_symlink(path, error);
    if (error) throw FileError(error.value(), "cannot write", path);
    path = path.parent_path() / to;  // absolute targets replace the whole
  }
  return path;
}

bool write_all(int fd, std::string_view rest) {
  while (!rest.empty()) {
    const ssize_t written = ::write(fd, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target) : target_(target) {
  struct stat info {};
  const bool exists = target != "-" && stat(target.c_str(), &info) == 0;
  if (!exists && target != "-" && errno != ENOENT) fail("cannot write");
  if (exists && S_ISDIR(info.st_mode)) throw FileError(EISDIR, "cannot write", target);
  if (target == "-" || (exists && !S_ISREG(info.st_mode))) {
    open_stream(target);
    return;
  }
  // Its folder would let it be replaced, but people protect by that what is not to be written again.
  if (exists && faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0) fail("cannot write");
  std::error_code error;
  if (exists) target_ = fs::canonical(target, error);
  if (error) target_ = target;
  if (!exists) target_ = follow_dangling(target);
  make_temporary(directory_of(target_));
  fchmod(fd_, exists ? info.st_mode & 07777 : default_mode());
}

AtomicFile::~AtomicFile() {
  for (const int fd : {fd_, stream_}) {
    if (fd >= 0) close(fd);
  }
  if (committed_ || path_.empty()) return;
  unlink(path_.c_str());
  release_temporary_file(path_.string());
}

void AtomicFile::open_stream(const fs::path& target) {
  if (target == "-") target_ = "standard output";
  // Known now, not when all is done.
  if (target == "-" && standard_output_is_closed()) throw FileError(EBADF, "cannot write", target_);
  stream_ =
      target == "-" ? fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0) : open(target.c_str(), O_WRONLY | O_CLOEXEC);
  if (stream_ < 0) fail("cannot write");
  std::error_code error;
  const fs::path directory = fs::temp_directory_path(error);
  if (error) throw FileError(error.value(), "cannot use the folder for temporary files", "$TMPDIR");
  try {
    make_temporary(directory);
  } catch (...) {  // no destructor will run
    close(stream_);
    throw;
  }
}

void AtomicFile::make_temporary(const fs::path& directory) {
  // Not after the target: its name may be as long as names can be.
  std::string name = (directory / ".affskel.XXXXXX").string();
  fd_ = mkostemp(name.data(), O_CLOEXEC);
  if (fd_ < 0 && errno == ENOENT) fail("cannot write, there is no folder " + directory.string());
  if (fd_ < 0) fail("cannot write");
  path_ = name;
  guard_temporary_file(name);
}

void AtomicFile::fail(const std::string& action) const {
  throw FileError(errno, action, target_);
}

void AtomicFile::write(std::string_view bytes) {
  buffer_.append(bytes);
  if (buffer_.size() >= kBufferBytes) flush();
}

void AtomicFile::flush() {
  if (!write_all(fd_, buffer_)) fail("cannot write");
  buffer_.clear();
}

void AtomicFile::sync() {
  flush();
  if (stream_ >= 0) return copy_to_stream();
  if (fsync(fd_) != 0) fail("cannot write");
}

void AtomicFile::commit() {
  sync();
  if (stream_ < 0) rename_temporary();
  int& last = stream_ < 0 ? fd_ : stream_;
  const int fd = last;
  last = -1;
  if (close(fd) != 0) fail("cannot write");
}

void AtomicFile::rename_temporary() {
  if (rename(path_.c_str(), target_.c_str()) != 0) fail("cannot rename the finished file");
  committed_ = true;
  release_temporary_file(path_.string());
  sync_directory(directory_of(target_));
}

void AtomicFile::copy_to_stream() {
  // Opened again: libraries that write by path may have replaced the file.
  const int from = open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (from < 0) fail("cannot read what was written");
  buffer_.resize(kBufferBytes);
  ssize_t got = 0;
  bool written = true;
  while (written && ((got = read(from, buffer_.data(), buffer_.size())) > 0 || (got < 0 && errno == EINTR))) {
    if (got > 0) written = write_all(stream_, std::string_view(buffer_).substr(0, std::size_t(got)));
  }
  const int error = errno;
  close(from);
  buffer_.clear();
  errno = error;
  if (!written || got < 0) fail("cannot write");
  // Emptied, so that nothing is sent twice.
  if (ftruncate(fd_, 0) != 0 || lseek(fd_, 0, SEEK_SET) != 0) fail("cannot write");
}

}  // namespace affskel::base
