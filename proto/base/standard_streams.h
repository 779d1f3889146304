#pragma once

#include <stdexcept>
#include <string>

#include "base/exit_code.h"

namespace affskel::base {

/// Where a standard stream is closed, the next file or connection would take its place and be written into.  Puts
/// something there by which what reads the one or writes to the other fails as it would, but for notes on standard
/// error.  For `.preinit_array` of a program: the initialisers of libraries come later, and gRPC's makes a descriptor.
void keep_standard_streams(int, char**, char**);

/// Whether it was closed when the program began.
bool standard_output_is_closed();

/// Standard output that did not take everything.
class OutputError : public std::runtime_error {
 public:
  /// @param error_number errno; 0: not known.
  explicit OutputError(int error_number);

  /// kUsage where it is closed, kClosedPipe when nobody reads it, of which nothing is told, else kLimit.
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// @throws OutputError.
void write_standard_output(const std::string& text);

/// What --help or --version shows, or why it cannot be shown.  @param program its name.
ExitCode show_help(const char* program, const std::string& text);

}  // namespace affskel::base
