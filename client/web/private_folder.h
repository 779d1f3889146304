#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>

namespace affskel::client {

/// A folder in $TMPDIR or /tmp that only this user can enter; removed with all that is in it.
class PrivateFolder {
 public:
  /// @throws ClientError when it cannot be made.
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// A path in it that was not given before.  @param extension with its dot.  Thread-safe.
  std::filesystem::path new_path(const std::string& extension);

 private:
  std::filesystem::path path_;
  std::atomic<std::uint64_t> given_{0};
};

/// A file that is removed with this.
class OwnedFile {
 public:
  explicit OwnedFile(std::filesystem::path path) : path_(std::move(path)) {}
  ~OwnedFile();
  OwnedFile(const OwnedFile&) = delete;
  OwnedFile& operator=(const OwnedFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// 0 when it is not there.
  std::uint64_t bytes() const;

 private:
  std::filesystem::path path_;
};

}  // namespace affskel::client
