#pragma once

#include <string>
#include <string_view>

namespace affskel::base {

/// What is read by the name of a file, and never lies on a disk: a file in memory, of this process alone,
/// that is gone with this.  For secrets, and for libraries that read by path.
class MemoryFile {
 public:
  /// @throws FileError naming `name` when there is no memory or descriptor for it.
  MemoryFile(const std::string& name, std::string_view bytes);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// Under which this process can open it.
  const std::string& path() const { return path_; }

  /// A reader that opens the path from now on gets these bytes, one that did before gets the old ones on.
  /// @throws FileError, and the old bytes stay.
  void replace(std::string_view bytes);

 private:
  const std::string name_;
  int fd_;
  std::string path_;
};

}  // namespace affskel::base
