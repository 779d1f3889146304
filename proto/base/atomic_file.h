#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/file_error.h"

namespace affskel::base {

/// A file that appears under its name complete or not at all: written to a temporary file in the same
/// directory, synced, renamed.  Without `commit` nothing is left behind, also after a signal whose handler
/// calls remove_guarded_files.  A target that is no regular file (a device, a pipe), and the standard
/// output, "-", get everything at `commit`, from a temporary file in $TMPDIR or /tmp: a transfer that breaks
/// off and begins again sends them nothing twice.  A symbolic link is followed, and a file that this user may not
/// write is not replaced.  All members throw FileError
/// naming the target.
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

  /// Puts everything written so far on the disk, so that `commit` has little left that can fail.
  void sync();

  /// Makes the file appear.  Call once, last.
  void commit();

 private:
  void open_stream(const std::filesystem::path& target);
  void make_temporary(const std::filesystem::path& directory);
  void flush();
  void rename_temporary();
  void copy_to_stream();
  [[noreturn]] void fail(const std::string& action) const;

  std::filesystem::path target_;
  std::filesystem::path path_;
  std::string buffer_;
  int fd_ = -1;      // of the temporary file
  int stream_ = -1;  // of a target that is no regular file
  bool committed_ = false;
};

}  // namespace affskel::base
