#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace affskel::integration {

/// bash in a pseudo-terminal of its own, 120 columns wide, without anybody's start files; killed at the
/// latest by the destructor.
class Terminal {
 public:
  /// Runs `line` to its end, or, where it is empty, asks for commands with the prompt "$ ".
  /// @param environment "NAME=value" entries on top of the present environment.
  explicit Terminal(const std::string& line, const std::vector<std::string>& environment = {});
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Types these characters.
  void type(const std::string& keys) const;
  /// What is shown from the last call on up to the end of the first `text`.  @throws std::runtime_error with
  /// what was shown when it does not come.
  std::string read_until(const std::string& text);
  /// Waits for the end.  @returns all that was shown since the last call.
  std::string read_all();
  /// Of the line, after read_all().
  int exit_code() const { return exit_code_; }

 private:
  bool read_some();

  pid_t pid_ = -1;
  int fd_ = -1;
  std::string shown_;
  int exit_code_ = -1;
};

}  // namespace affskel::integration
