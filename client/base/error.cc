#include "client/base/error.h"

#include <cerrno>
#include <cstring>

namespace affskel::client {

std::string ClientError::for_people() const {
  std::string text = file_;
  if (line_ > 0) text += (text.empty() ? "line " : ":") + std::to_string(line_);
  if (!text.empty()) text += ": ";
  return text + what();
}

ClientError error_from_core(const core::CoreError& error, const std::string& file) {
  ExitCode code = ExitCode::kInternal;
  switch (error.code()) {
    case core::CoreError::Code::kBadInput:
      code = file.empty() ? ExitCode::kUsage : ExitCode::kBadInput;
      break;
    case core::CoreError::Code::kLimit:
      code = ExitCode::kLimit;
      break;
    case core::CoreError::Code::kCancelled:
      code = ExitCode::kCancelled;
      break;
    case core::CoreError::Code::kInternal:
      break;
  }
  std::string message = error.what();
  // The error holds the line on its own: it need not be in the message, too.
  const std::string place = "line " + std::to_string(error.line()) + ": ";
  if (error.line() > 0 && message.starts_with(place)) message.erase(0, place.size());
  return {code, message, file, error.line()};
}

ClientError error_from_errno(int error_number, const std::string& action, const std::string& file,
                             ExitCode otherwise) {
  // A standard stream that was closed when the program began; of no other file is the descriptor bad.
  if (error_number == EBADF) return {ExitCode::kUsage, "is closed", file};
  ExitCode code = otherwise;
  if (error_number == ENOSPC || error_number == EDQUOT || error_number == EFBIG) code = ExitCode::kLimit;
  if (error_number == EPIPE) code = ExitCode::kClosedPipe;
  if (error_number == EACCES || error_number == EPERM || error_number == EROFS) code = ExitCode::kNotAllowed;
  return {code, action + ": " + std::strerror(error_number), file};
}

ClientError error_from_file(const base::FileError& error) {
  return error_from_errno(error.code().value(), error.action(), error.file());
}

}  // namespace affskel::client
