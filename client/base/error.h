#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/exit_code.h"
#include "base/file_error.h"
#include "core/base/error.h"

namespace affskel::client {

using base::exit_code_name;
using base::ExitCode;

/// The one error type of the client: what to tell people, where, and how to exit.
class ClientError : public std::runtime_error {
 public:
  /// @param file the file it is about, empty = none; @param line counted from 1, 0 = none.
  ClientError(ExitCode exit_code, const std::string& message, std::string file = {}, std::uint64_t line = 0)
      : std::runtime_error(message), exit_code_(exit_code), file_(std::move(file)), line_(line) {}

  ExitCode exit_code() const { return exit_code_; }
  const std::string& file() const { return file_; }
  std::uint64_t line() const { return line_; }

  /// `FILE:LINE: message` as far as these are known.
  std::string for_people() const;

 private:
  ExitCode exit_code_;
  std::string file_;
  std::uint64_t line_;
};

/// Error for a core error about the file (or, when `file` is empty, about an option).
ClientError error_from_core(const core::CoreError& error, const std::string& file);

/// Error for a file that could not be written, as error_from_errno.
ClientError error_from_file(const base::FileError& error);

/// Error for a failed system call on `file`, by errno: disk full 8, a pipe without a reader 141, no
/// permission 7, a standard stream that is closed 2, otherwise `otherwise`.
ClientError error_from_errno(int error_number, const std::string& action, const std::string& file,
                             ExitCode otherwise = ExitCode::kUsage);

}  // namespace affskel::client
