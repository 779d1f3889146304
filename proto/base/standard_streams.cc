#include "base/standard_streams.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <iostream>
#include <system_error>

namespace affskel::base {
namespace {

// Of a stream that failed before anybody looked, errno tells nothing any more; the pipe itself does.
bool nobody_reads_standard_output() {
  pollfd pipe{STDOUT_FILENO, 0, 0};
  return poll(&pipe, 1, 0) == 1 && (pipe.revents & POLLERR) != 0;
}

ExitCode output_error_code(int error_number) {
  if (error_number == EBADF || standard_output_is_closed()) return ExitCode::kUsage;
  const bool no_reader = error_number == EPIPE || (error_number == 0 && nobody_reads_standard_output());
  return no_reader ? ExitCode::kClosedPipe : ExitCode::kLimit;
}

std::string output_error_text(int error_number) {
  switch (output_error_code(error_number)) {
    case ExitCode::kUsage:
      return "standard output: is closed";
    case ExitCode::kClosedPipe:
      return "nobody reads standard output";
    default:
      return "cannot write to standard output: " +
             (error_number == 0 ? "there is no room left" : std::generic_category().message(error_number));
  }
}

}  // namespace

void keep_standard_streams(int, char**, char**) {
  constexpr int kModes[] = {O_WRONLY, O_RDONLY, O_WRONLY};
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(fd, F_GETFD) == -1 && open("/dev/null", kModes[fd]) != fd) std::abort();
  }
}

bool standard_output_is_closed() {
  const int flags = fcntl(STDOUT_FILENO, F_GETFL);
  return flags == -1 || (flags & O_ACCMODE) == O_RDONLY;
}

OutputError::OutputError(int error_number)
    : std::runtime_error(output_error_text(error_number)), code_(output_error_code(error_number)) {}

void write_standard_output(const std::string& text) {
  errno = 0;
  if (!(std::cout << text).flush()) throw OutputError(errno);
}

ExitCode show_help(const char* program, const std::string& text) {
  try {
    write_standard_output(text);
    return ExitCode::kDone;
  } catch (const OutputError& error) {
    if (error.code() != ExitCode::kClosedPipe) std::cerr << program << ": " << error.what() << '\n';
    return error.code();
  }
}

}  // namespace affskel::base
