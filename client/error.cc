#include "client/error.h"

#include <cerrno>
#include <cstring>

namespace affskel::client {
namespace {

ExitCode exit_code_of(grpc::StatusCode code) {
  switch (code) {
    case grpc::StatusCode::INVALID_ARGUMENT:
    case grpc::StatusCode::ALREADY_EXISTS:
    case grpc::StatusCode::OUT_OF_RANGE:
      return ExitCode::kUsage;
    case grpc::StatusCode::NOT_FOUND:
    case grpc::StatusCode::DATA_LOSS:  // what was stored is damaged: there is nothing to be had
      return ExitCode::kNotFound;
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::CANCELLED:  // by a server that closes; on this side nobody cancels
    case grpc::StatusCode::DEADLINE_EXCEEDED:
    case grpc::StatusCode::ABORTED:
      return ExitCode::kUnreachable;
    case grpc::StatusCode::PERMISSION_DENIED:
    case grpc::StatusCode::UNAUTHENTICATED:
    case grpc::StatusCode::FAILED_PRECONDITION:
      return ExitCode::kNotAllowed;
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
      return ExitCode::kLimit;
    default:
      return ExitCode::kInternal;
  }
}

}  // namespace

const char* exit_code_name(ExitCode code) {
  switch (code) {
    case ExitCode::kDone:
      return "DONE";
    case ExitCode::kJobFailed:
      return "JOB_FAILED";
    case ExitCode::kUsage:
      return "USAGE";
    case ExitCode::kBadInput:
      return "BAD_INPUT";
    case ExitCode::kNotFound:
      return "NOT_FOUND";
    case ExitCode::kUnreachable:
      return "UNREACHABLE";
    case ExitCode::kCancelled:
      return "CANCELLED";
    case ExitCode::kNotAllowed:
      return "NOT_ALLOWED";
    case ExitCode::kLimit:
      return "LIMIT";
    case ExitCode::kInternal:
      break;
  }
  return "INTERNAL";
}

std::string ClientError::for_people() const {
  std::string text = file_;
  if (line_ > 0) text += (text.empty() ? "line " : ":") + std::to_string(line_);
  if (!text.empty()) text += ": ";
  return text + what();
}

ClientError error_from_status(const grpc::Status& status, const std::string& server, ExitCode not_yet) {
  const bool precondition = status.error_code() == grpc::StatusCode::FAILED_PRECONDITION;
  const ExitCode code = precondition ? not_yet : exit_code_of(status.error_code());
  const std::string detail = status.error_message();
  switch (status.error_code()) {
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::CANCELLED:
      return {code, "cannot reach the server at " + server + ": " + detail};
    case grpc::StatusCode::DEADLINE_EXCEEDED:
      return {code, "the server at " + server + " did not answer in time"};
    case grpc::StatusCode::UNIMPLEMENTED:
      return {code, "the server at " + server + " does not offer this call (an older version?): " + detail};
    default:
      return {code, detail.empty() ? "the server answered with status " +
                                         std::to_string(static_cast<int>(status.error_code()))
                                   : detail};
  }
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
  // The place is told apart from the message here, and once is enough.
  const std::string place = "line " + std::to_string(error.line()) + ": ";
  if (error.line() > 0 && message.starts_with(place)) message.erase(0, place.size());
  return {code, message, file, error.line()};
}

ClientError error_from_errno(int error_number, const std::string& action, const std::string& file,
                             ExitCode otherwise) {
  ExitCode code = otherwise;
  if (error_number == ENOSPC || error_number == EDQUOT || error_number == EFBIG || error_number == EPIPE)
    code = ExitCode::kLimit;
  if (error_number == EACCES || error_number == EPERM || error_number == EROFS) code = ExitCode::kNotAllowed;
  return {code, action + ": " + std::strerror(error_number), file};
}

}  // namespace affskel::client
