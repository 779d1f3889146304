#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace affskel::client {

/// A file that appears under its name complete or not at all: written to a temporary file in the same
/// directory, synced, renamed.  Without `commit` nothing is left behind, also after an interrupt.  A target
/// that is no regular file (a device, a pipe) is written to directly; a symbolic link is followed.  All
/// members throw ClientError naming the target.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends; buffered.
  void write(std::string_view bytes);

  /// For libraries that write by path, instead of `write`.
  const std::filesystem::path& path() const { return path_; }
  const std::filesystem::path& target() const { return target_; }
  /// Whether the target is replaced by a rename and can thus be written in any order.
  bool is_regular() const { return regular_; }

  /// Puts everything written so far on the disk, so that `commit` has little left that can fail.
  void sync();

  /// Makes the file appear.  Call once, last.
  void commit();

 private:
  void flush();
  [[noreturn]] void fail(const char* action) const;

  std::filesystem::path target_;
  std::filesystem::path path_;
  std::string buffer_;
  int fd_ = -1;
  bool regular_ = true;
  bool committed_ = false;
};

}  // namespace affskel::client
