#pragma once

#include <string>
#include <system_error>

namespace affskel::base {

/// What could not be done to a file.
class FileError : public std::system_error {
 public:
  /// @param error_number errno; @param action what failed, e.g. "cannot write"; @param file as its user named
  /// it.
  FileError(int error_number, const std::string& action, const std::string& file)
      : std::system_error(error_number, std::generic_category(), file + ": " + action),
        action_(action),
        file_(file) {}

  const std::string& action() const { return action_; }
  const std::string& file() const { return file_; }

 private:
  std::string action_, file_;
};

}  // namespace affskel::base
