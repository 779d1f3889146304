#pragma once

#include <string>

namespace affskel::client {

/// A secret that is read by the name of a file, and never lies on a disk: a file in memory, of this process
/// alone, that is gone with this.
class SecretFile {
 public:
  /// @throws ClientError kLimit when there is no memory or descriptor for it.
  explicit SecretFile(const std::string& secret);
  ~SecretFile();
  SecretFile(const SecretFile&) = delete;
  SecretFile& operator=(const SecretFile&) = delete;

  /// Under which this process can open it.
  const std::string& path() const { return path_; }

 private:
  int fd_;
  std::string path_;
};

}  // namespace affskel::client
