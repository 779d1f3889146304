#include "client/web/secret_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>

#include "client/base/error.h"

namespace affskel::client {

SecretFile::SecretFile(const std::string& secret) : fd_(memfd_create("secret", MFD_CLOEXEC)) {
  if (fd_ < 0) throw error_from_errno(errno, "cannot keep a secret in memory", "", ExitCode::kLimit);
  path_ = "/proc/self/fd/" + std::to_string(fd_);
  if (write(fd_, secret.data(), secret.size()) == static_cast<ssize_t>(secret.size())) return;
  const int error = errno;
  close(fd_);
  throw error_from_errno(error, "cannot keep a secret in memory", "", ExitCode::kLimit);
}

SecretFile::~SecretFile() {
  close(fd_);
}

}  // namespace affskel::client
