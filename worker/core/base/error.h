#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace affskel::core {

/// The one error type of the core.
class CoreError : public std::runtime_error {
 public:
  enum class Code {
    kBadInput,   ///< the mesh or a parameter is wrong; retrying does not help
    kLimit,      ///< too large for this machine or for the number formats
    kCancelled,  ///< the execution context asked to stop
    kInternal,   ///< an invariant of the algorithm broke: a bug, or a mesh that crosses itself
  };

  /// @param line line of the input file, counted from 1; 0 = not about a line.
  CoreError(Code code, const std::string& message, std::uint64_t line = 0)
      : std::runtime_error(message), code_(code), line_(line) {}

  Code code() const { return code_; }
  std::uint64_t line() const { return line_; }

 private:
  Code code_;
  std::uint64_t line_;
};

/// Refuses a mesh, a file or a parameter: @throws CoreError kBadInput.
[[noreturn]] inline void refuse(const std::string& message, std::uint64_t line = 0) {
  throw CoreError(CoreError::Code::kBadInput, message, line);
}

}  // namespace affskel::core
